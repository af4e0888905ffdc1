#ifndef DUET_CONTRIB_FORMATS_FBX_SKIN_WRITING_H_
#define DUET_CONTRIB_FORMATS_FBX_SKIN_WRITING_H_

#include <set>

#include "absl/status/status.h"
#include "assimp/scene.h"
#include "contrib/formats/fbx/node_tree.h"
#include "model/formats/gltf/gltf_writer.h"

namespace duet::contrib::formats::fbx {

namespace gltf = ::duet::formats::gltf;

// Adds each mesh with bones and its skin: triangles with positions, normals, influences and their
// diffuse colour. The nodes of `tree` are the first of the document.
//
// Joints that no vertex follows are part of a character too: a skin's skeleton starts at the
// highest of the `animated` nodes above its bones.
//
// Errors: INVALID_ARGUMENT for too many vertices.
absl::Status WriteSkins(const aiScene& scene, const NodeTree& tree, const std::set<int>& animated,
                        gltf::GltfWriter* writer);

}  // namespace duet::contrib::formats::fbx

#endif  // DUET_CONTRIB_FORMATS_FBX_SKIN_WRITING_H_
