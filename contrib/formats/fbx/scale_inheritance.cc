#include "contrib/formats/fbx/scale_inheritance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/index.h"

namespace duet::contrib::formats::fbx {
namespace {

using base::Index;
using retargeting::Affine;
using retargeting::Parts;
using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr double kSameScale = 1e-4;  // exporters round

bool IsUniform(Vec3d scale) {
  const auto [least, most] = std::minmax({scale.x, scale.y, scale.z});
  return most - least <= kSameScale * std::max(std::abs(least), std::abs(most));
}

bool IsOne(Vec3d scale) { return Norm(scale - Vec3d{1, 1, 1}) <= kSameScale; }

Affine Turning(Quaternion turn) { return retargeting::FromParts({{}, turn, {1, 1, 1}}); }
Affine Scaling(Vec3d scale) { return retargeting::FromParts({{}, {}, scale}); }

// A node in the file's world: its linear map is `turn` after `scale`.
struct World {
  Quaternion turn;
  Affine scale;
  Affine own_scale;
  Vec3d origin;
  double size = 1;  // the uniform scale in the result; negative if mirrored
};

// The scale of a node in its own axes.
Affine InheritedScale(const World& parent, const Parts& own, Inherits inherits) {
  const Affine scale = Scaling(own.scale);
  if (inherits == Inherits::kScaleAfterRotation) return parent.scale * scale;
  if (inherits == Inherits::kAllButTheParentsScale) {
    return parent.scale * Inverse(parent.own_scale).value_or(Affine{}) * scale;
  }
  return Turning(Inverse(own.rotation)) * parent.scale * Turning(own.rotation) * scale;
}

}  // namespace

bool InheritsPlainly(const NodeTree& tree, const std::vector<Affine>& locals) {
  std::vector<bool> uniform_above(tree.nodes.size(), true);
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const int parent = tree.nodes[n].parent;
    if (parent < 0) continue;
    const Vec3d scale = ToParts(locals[Index(parent)]).scale;
    uniform_above[n] = uniform_above[Index(parent)] && IsUniform(scale);
    const Inherits inherits = tree.nodes[n].inherits;
    if (inherits == Inherits::kScaleAfterRotation && !uniform_above[n]) return false;
    if (inherits == Inherits::kAllButTheParentsScale && !IsOne(scale)) return false;
  }
  return true;
}

std::vector<Parts> InheritScales(const NodeTree& tree, const std::vector<Affine>& locals) {
  std::vector<World> worlds;
  std::vector<Parts> inherited;
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const int above = tree.nodes[n].parent;
    const Parts own = ToParts(locals[n]);
    const World parent = above < 0 ? World{} : worlds[Index(above)];
    World world;
    world.turn = parent.turn * own.rotation;
    world.own_scale = Scaling(own.scale);
    world.scale = InheritedScale(parent, own, tree.nodes[n].inherits);
    world.origin = parent.origin + Rotate(parent.turn, parent.scale.Turn(own.translation));
    world.size = std::copysign(world.scale.Scale(), parent.size * own.scale.x);
    // Some programs hide a bone by the scale 0. What is below it is in one place with it.
    const double inside = parent.size == 0 ? 0 : 1 / parent.size;
    const double size = world.size * inside;
    const Vec3d offset = Rotate(Inverse(parent.turn), world.origin - parent.origin);
    Parts parts{offset * inside, own.rotation, {size, size, size}};
    if (above < 0) parts = ToParts(tree.root * FromParts(parts));
    inherited.push_back(parts);
    worlds.push_back(world);
  }
  return inherited;
}

}  // namespace duet::contrib::formats::fbx
