#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_PARTS_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_PARTS_H_

#include <cstddef>
#include <string>
#include <vector>

#include "model/formats/gltf/gltf_writer.h"
#include "model/motion/provenance.h"
#include "model/retargeting/mannequin_look.h"
#include "model/retargeting/mesh_builder.h"
#include "model/retargeting/rotation.h"
#include "nlohmann/json.hpp"

// What several writers of glTF have in common.

namespace duet::formats::gltf {

// One animation of a document, named "duet", with keys at every frame.
class AnimationWriter {
 public:
  // `writer` outlives the animation.
  AnimationWriter(std::size_t frames, double frame_rate_hz, GltfWriter* writer);

  // [frames], in the node's parent
  void Translate(int node, const std::vector<retargeting::Vec3d>& translations);
  void Rotate(int node, const std::vector<retargeting::Quaternion>& rotations);

  // The animation's JSON.
  nlohmann::ordered_json Take() { return std::move(json_); }

 private:
  void AddTrack(int node, const char* path, int values);

  GltfWriter& writer_;
  nlohmann::ordered_json json_;
  int times_;  // accessor
};

nlohmann::ordered_json ToArray(retargeting::Vec3d a);

// A skin of joints that are not turned at rest, the nodes from `first_joint` on. Returns its index.
int AddSkin(const std::string& name, int first_joint,
            const std::vector<retargeting::Vec3d>& rest_positions, GltfWriter* writer);

// Each returns the index.
int AddMaterial(const std::string& name, const retargeting::Look& look, GltfWriter* writer);

// A primitive of a mesh that is skinned to `joint_count` joints.
nlohmann::ordered_json AddPrimitive(const retargeting::SkinnedMesh& mesh, std::size_t joint_count,
                                    int material, GltfWriter* writer);

// What a scene's extras say of how its follower was made.
nlohmann::ordered_json Extras(const motion::Provenance& provenance);

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_PARTS_H_
