#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_PARTS_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_PARTS_H_

#include <cstddef>
#include <string>
#include <vector>

#include "model/formats/gltf/gltf_writer.h"
#include "model/motion/provenance.h"
#include "model/retargeting/mannequin.h"
#include "model/retargeting/rotation.h"
#include "nlohmann/json.hpp"

// Parts that several writers of glTF share.

namespace duet::formats::gltf {

// One animation of a document, with keys at every frame.
class AnimationWriter {
 public:
  // `writer` must outlive this object.
  AnimationWriter(const std::string& name, std::size_t frames, double frame_rate_hz,
                  GltfWriter* writer);

  // Shapes: [frames], in the axes of the node's parent.
  void Translate(int node, const std::vector<retargeting::Vec3d>& translations);
  void Rotate(int node, const std::vector<retargeting::Quaternion>& rotations);
  void Scale(int node, const std::vector<retargeting::Vec3d>& scales);

  // The animation's JSON.
  nlohmann::ordered_json Take() { return std::move(json_); }

 private:
  void AddTrack(int node, const char* path, int values);

  GltfWriter& writer_;
  nlohmann::ordered_json json_;
  int times_;  // accessor
};

nlohmann::ordered_json ToArray(retargeting::Vec3d a);

// Adds a skin of joints that are not rotated at rest, the nodes from `first_joint`. Returns its
// index.
int AddSkin(const std::string& name, int first_joint,
            const std::vector<retargeting::Vec3d>& rest_positions, GltfWriter* writer);

// Returns the index of the new material.
int AddMaterial(const std::string& name, const retargeting::Look& look, GltfWriter* writer);

// Returns a primitive of a mesh that is skinned to `joint_count` joints.
nlohmann::ordered_json AddPrimitive(const retargeting::SkinnedMesh& mesh, std::size_t joint_count,
                                    int material, GltfWriter* writer);

// Formats the provenance of a follower for a scene's extras.
nlohmann::ordered_json Extras(const motion::Provenance& provenance);

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_PARTS_H_
