#ifndef DUET_MODEL_FORMATS_FBX_PROGRAM_SKIN_WRITING_H_
#define DUET_MODEL_FORMATS_FBX_PROGRAM_SKIN_WRITING_H_

#include <set>

#include "absl/status/status.h"
#include "assimp/scene.h"
#include "model/formats/fbx/program/node_tree.h"
#include "model/formats/gltf/gltf_writer.h"

namespace duet::formats::fbx::program {

// Adds a skin for each mesh with bones, and with `with_meshes` the meshes: triangles with
// positions, normals, influences and their diffuse colour. The nodes of `tree` are the first of the
// document.
//
// Joints that no vertex follows are part of a character too: a skin's skeleton starts at the
// highest of the `animated` nodes above its bones.
//
// Errors: INVALID_ARGUMENT for too many vertices.
absl::Status WriteSkins(const aiScene& scene, const NodeTree& tree, const std::set<int>& animated,
                        bool with_meshes, gltf::GltfWriter* writer);

}  // namespace duet::formats::fbx::program

#endif  // DUET_MODEL_FORMATS_FBX_PROGRAM_SKIN_WRITING_H_
