#include "contrib/formats/fbx/node_tree.h"

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "assimp/version.h"
#include "contrib/formats/fbx/scale_inheritance.h"
#include "model/base/index.h"
#include "model/motion/motion_limits.h"

namespace duet::contrib::formats::fbx {
namespace {

using retargeting::Affine;
using retargeting::Vec3d;

// Nodes that assimp adds for pivots, and those of them for the offset of a node's meshes.
constexpr char kPivot[] = "_$AssimpFbx$_", kGeometry[] = "_$AssimpFbx$_Geometric";
constexpr char kInverse[] = "Inverse";
constexpr std::size_t kMostNodes = 4 * motion::kMaxFileJoints;  // cameras, lights and meshes too

Vec3d ToVector(ai_real x, ai_real y, ai_real z) {
  return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

using base::Index;

Affine Product(const std::vector<const aiNode*>& chain, Affine product = {}) {
  for (const aiNode* link : chain) product = product * ToAffine(link->mTransformation);
  return product;
}

// The local transforms that the file was saved with.
std::vector<Affine> SavedPose(const NodeTree& tree) {
  std::vector<Affine> locals;
  for (const Node& node : tree.nodes) locals.push_back(Product(node.chain));
  if (InheritsPlainly(tree, locals)) {
    for (std::size_t n = 0; n < locals.size(); ++n) {
      if (tree.nodes[n].parent < 0) locals[n] = Product(tree.nodes[n].chain, tree.root);
    }
    return locals;
  }
  std::vector<Affine> rest;
  for (const retargeting::Parts& parts : InheritScales(tree, locals)) {
    rest.push_back(FromParts(parts));
  }
  return rest;
}

// The node that holds each mesh, -1 for none. [meshes]
std::vector<int> HoldersOf(const aiScene& scene, const NodeTree& tree) {
  std::vector<int> holders(scene.mNumMeshes, -1);
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const aiNode& last = *tree.nodes[n].chain.back();
    for (unsigned i = 0; i < last.mNumMeshes; ++i) {
      if (last.mMeshes[i] < scene.mNumMeshes) holders[last.mMeshes[i]] = static_cast<int>(n);
    }
  }
  return holders;
}

// assimp 5.4 states the pose in which a bone was bound relative to the node above the mesh, and
// uses that node's local transform where its transform in the world is needed.
bool StatesBonesRelativeToParent() {
  return aiGetVersionMajor() > 5 || (aiGetVersionMajor() == 5 && aiGetVersionMinor() >= 4);
}

// From a mesh, which `holder` holds at `place` in the file's world, to the joint of its bone.
Affine ToJoint(const aiBone& bone, const Node& holder, const Affine& place) {
  const Affine offset = ToAffine(bone.mOffsetMatrix);
  if (!StatesBonesRelativeToParent()) return offset;
  // The scene's root had no transform when assimp computed the offset.
  const aiNode& above = *holder.outermost->mParent;
  const Affine local = above.mParent == nullptr ? Affine{} : ToAffine(above.mTransformation);
  return offset * Inverse(local).value_or(Affine{}) * place;
}

// A file is saved in any pose. A skin states where its bones were when it was bound to them.
void TakeRestOfSkins(const aiScene& scene, NodeTree* tree) {
  std::vector<Affine> world = WorldOf(*tree);
  const std::vector<int> holders = HoldersOf(scene, *tree);
  const Affine to_file = Inverse(tree->root).value_or(Affine{});
  std::vector<Affine> bound = world;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    if (holders[m] < 0) continue;
    const std::size_t holder = Index(holders[m]);
    for (unsigned b = 0; b < scene.mMeshes[m]->mNumBones; ++b) {
      const aiBone& bone = *scene.mMeshes[m]->mBones[b];
      const Affine to_joint = ToJoint(bone, tree->nodes[holder], to_file * world[holder]);
      tree->to_joint[&bone] = to_joint * Product(tree->nodes[holder].geometry);
      const int node = tree->Find(bone.mName.C_Str());
      if (node < 0 || tree->bound[Index(node)]) continue;
      const std::optional<Affine> from_joint = Inverse(to_joint);
      if (!from_joint.has_value()) continue;
      tree->bound[Index(node)] = true;
      bound[Index(node)] = world[holder] * *from_joint;
    }
  }
  // The others keep their place relative to their parent.
  for (std::size_t n = 0; n < tree->nodes.size(); ++n) {
    const int parent = tree->nodes[n].parent;
    const Affine above = parent < 0 ? Affine{} : world[Index(parent)];
    if (tree->bound[n]) {
      if (const std::optional<Affine> below = Inverse(above)) tree->rest[n] = *below * bound[n];
    }
    world[n] = above * tree->rest[n];
  }
}

// A node that is still to be visited, below `parent` and its own pivots.
struct Open {
  const aiNode* node;
  int parent;
  std::vector<const aiNode*> pivots;
};

// Sorts the pivots of a node. Those that undo the offset of the parent's meshes are dropped.
Node MakeNode(const Open& found) {
  Node node;
  node.name = found.node->mName.C_Str();
  node.parent = found.parent;
  node.outermost = found.pivots.empty() ? found.node : found.pivots.front();
  for (const aiNode* pivot : found.pivots) {
    const absl::string_view name = pivot->mName.C_Str();
    if (!absl::StrContains(name, kGeometry)) {
      node.chain.push_back(pivot);
    } else if (!absl::EndsWith(name, kInverse)) {
      node.geometry.push_back(pivot);
    }
  }
  node.chain.push_back(found.node);
  int type = static_cast<int>(Inherits::kAll);
  const aiMetadata* const stated = found.node->mMetaData;
  if (stated != nullptr && stated->Get("InheritType", type) && type >= 0 && type <= 2) {
    node.inherits = static_cast<Inherits>(type);
  }
  return node;
}

}  // namespace

Affine ToAffine(const aiMatrix4x4& m) {
  return {ToVector(m.a1, m.b1, m.c1), ToVector(m.a2, m.b2, m.c2), ToVector(m.a3, m.b3, m.c3),
          ToVector(m.a4, m.b4, m.c4)};
}

std::string PivotName(const std::string& node, const char* part) {
  return absl::StrCat(node, kPivot, part);
}

int NodeTree::Find(const std::string& name) const {
  const auto found = by_name.find(name);
  return found == by_name.end() ? -1 : found->second;
}

std::vector<Affine> WorldOf(const NodeTree& tree) {
  std::vector<Affine> world;
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const int parent = tree.nodes[n].parent;
    world.push_back(parent < 0 ? tree.rest[n] : world[Index(parent)] * tree.rest[n]);
  }
  return world;
}

absl::StatusOr<NodeTree> MakeNodeTree(const aiScene& scene, const Affine& to_world) {
  NodeTree tree;
  // FBX has no transform above its nodes. assimp 5.4 applies the stated axes and unit there;
  // `to_world` does so for every version.
  tree.root = to_world;
  std::vector<Open> open;
  const auto push_children = [&open](const aiNode& node, int parent,
                                     const std::vector<const aiNode*>& pivots) {
    for (unsigned i = node.mNumChildren; i-- > 0;) {
      open.push_back({node.mChildren[i], parent, pivots});
    }
  };
  push_children(*scene.mRootNode, -1, {});
  while (!open.empty()) {
    Open next = std::move(open.back());
    open.pop_back();
    if (absl::StrContains(next.node->mName.C_Str(), kPivot)) {
      next.pivots.push_back(next.node);
      if (next.pivots.size() > kMostNodes) break;
      push_children(*next.node, next.parent, next.pivots);
      continue;
    }
    if (tree.nodes.size() == kMostNodes) {
      return absl::InvalidArgumentError(
          absl::StrCat("nodes: expected at most ", kMostNodes, ", got more"));
    }
    const int index = static_cast<int>(tree.nodes.size());
    tree.nodes.push_back(MakeNode(next));
    tree.by_name.emplace(tree.nodes.back().name, index);
    ++tree.counts[tree.nodes.back().name];
    push_children(*next.node, index, {});
  }
  tree.rest = SavedPose(tree);
  tree.bound.resize(tree.nodes.size());
  TakeRestOfSkins(scene, &tree);
  return tree;
}

}  // namespace duet::contrib::formats::fbx
