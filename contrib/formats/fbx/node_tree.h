#ifndef DUET_CONTRIB_FORMATS_FBX_NODE_TREE_H_
#define DUET_CONTRIB_FORMATS_FBX_NODE_TREE_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "assimp/scene.h"
#include "model/retargeting/affine.h"

namespace duet::contrib::formats::fbx {

retargeting::Affine ToAffine(const aiMatrix4x4& matrix);

// How a node takes over its parent's scale: FbxTransform::EInheritType, in the order of its
// numbers.
enum class Inherits {
  kScaleAfterRotation,    // RrSs: the parent's scale applies along the node's own axes
  kAll,                   // RSrs: as in most programs
  kAllButTheParentsScale  // Rrs: the parent's own scale does not apply ("segment scale compensate")
};

// A node of the file. assimp splits the pivots and the parts of its transform into several nodes,
// which are a chain here.
struct Node {
  std::string name;
  int parent = -1;                      // an earlier node
  std::vector<const aiNode*> chain;     // from the outermost; their product is the local transform
  std::vector<const aiNode*> geometry;  // from the node to its meshes; does not apply to children
  const aiNode* outermost = nullptr;    // of all of them
  Inherits inherits = Inherits::kAll;
};

// The name of the node that assimp adds for a part of a node's transform ("PreRotation").
std::string PivotName(const std::string& node, const char* part);
// The parts that a local transform may have, from the outermost.
inline constexpr const char* kTransformParts[] = {
    "Translation",  "RotationOffset", "RotationPivot",        "PreRotation",
    "Rotation",     "PostRotation",   "RotationPivotInverse", "ScalingOffset",
    "ScalingPivot", "Scaling",        "ScalingPivotInverse"};

// The nodes below the scene's root, parents first.
struct NodeTree {
  std::vector<Node> nodes;
  retargeting::Affine root;  // the scene's root, which is the parent of all trees

  // The first node of that name; -1 if there is none.
  int Find(const std::string& name) const;

  std::map<std::string, int> by_name;
  std::map<std::string, int> counts;      // nodes of each name
  std::vector<retargeting::Affine> rest;  // [nodes], local
  // Nodes whose rest is that of a skin instead of the pose that the file was saved in. [nodes]
  std::vector<bool> bound;
  // From the vertices of a mesh to a bone's joint, when they were bound.
  std::map<const aiBone*, retargeting::Affine> to_joint;
};

// The transforms of the nodes at rest, in the world. [nodes]
std::vector<retargeting::Affine> WorldOf(const NodeTree& tree);

// `to_world` is applied after the scene's root.
// Errors: INVALID_ARGUMENT for too many nodes.
absl::StatusOr<NodeTree> MakeNodeTree(const aiScene& scene, const retargeting::Affine& to_world);

}  // namespace duet::contrib::formats::fbx

#endif  // DUET_CONTRIB_FORMATS_FBX_NODE_TREE_H_
