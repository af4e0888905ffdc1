#include "model/motion/inferred_coordinates.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/base/median.h"
#include "model/motion/limb_lengths.h"

namespace duet::motion {
namespace {

constexpr InferredUnit kUnits[] = {{"centimetres", 0.01},
                                   {"metres", 1},
                                   {"millimetres", 0.001},
                                   {"inches", 0.0254},
                                   {"CMU's unit (0.45 to the inch)", 0.0254 / 0.45},
                                   {"decimetres", 0.1}};

}  // namespace

bool IsLegLength(double metres) { return metres >= kShortestLeg && metres <= kLongestLeg; }

double LegLength(const Skeleton& skeleton, const Poses& poses) {
  const std::vector<float> medians = MedianBoneLengths(skeleton, poses);
  std::vector<double> to_parent(skeleton.joint_names.size());
  for (std::size_t i = 0; i < skeleton.bones.size(); ++i) {
    to_parent[static_cast<std::size_t>(skeleton.bones[i].child)] = static_cast<double>(medians[i]);
  }
  const std::vector<int> parents = skeleton.Parents();
  double length = 0;
  for (const int foot : {skeleton.feet->left, skeleton.feet->right}) {
    for (int joint = foot; joint != skeleton.root;
         joint = parents[static_cast<std::size_t>(joint)]) {
      length += to_parent[static_cast<std::size_t>(joint)];
    }
  }
  return length / 2;
}

std::optional<InferredUnit> InferUnit(std::vector<double> leg_lengths) {
  const double length = base::Median(std::move(leg_lengths));
  for (const InferredUnit& unit : kUnits) {
    if (IsLegLength(length * unit.metres)) return unit;
  }
  return std::nullopt;
}

std::optional<UpAxis> InferUpAxis(const Skeleton& skeleton,
                                  const std::vector<const Poses*>& people) {
  if (!skeleton.feet) return std::nullopt;
  Vec3 up;
  for (const Poses* poses : people) {
    for (int t = 0; t < poses->frame_count(); ++t) {
      const Vec3 feet =
          (poses->at(t, skeleton.feet->left) + poses->at(t, skeleton.feet->right)) / 2;
      const Vec3 body = poses->at(t, skeleton.root) - feet;
      if (Norm(body) > 0) up += body / Norm(body);
    }
  }
  const float most = std::max({std::abs(up.x), std::abs(up.y), std::abs(up.z)});
  if (most == 0) return std::nullopt;
  if (up.y == most) return UpAxis::kYUp;
  if (up.z == most) return UpAxis::kZUp;
  if (-up.y == most) return UpAxis::kYDown;
  return std::nullopt;
}

}  // namespace duet::motion
