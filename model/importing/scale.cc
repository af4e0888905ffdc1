#include "model/importing/scale.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace duet::importing {
namespace {

const std::vector<Unit>& Units() {
  static const auto* const units =
      new std::vector<Unit>{{1, "metres"},
                            {0.01, "centimetres"},
                            {0.001, "millimetres"},
                            {0.0254, "inches"},
                            {0.0254 / 0.45, "CMU's (0.45 to the inch)"}};
  return *units;
}

}  // namespace

double LegLength(const motion::Skeleton& skeleton, const motion::Poses& poses) {
  const std::vector<int> parents = skeleton.Parents();
  double length = 0;
  for (const int foot : {skeleton.feet->left, skeleton.feet->right}) {
    for (int at = foot; parents[static_cast<std::size_t>(at)] >= 0;
         at = parents[static_cast<std::size_t>(at)]) {
      length += static_cast<double>(
          Distance(poses.at(0, at), poses.at(0, parents[static_cast<std::size_t>(at)])));
    }
  }
  return length / 2;
}

std::optional<Unit> FindUnit(std::vector<double> legs) {
  const auto middle = legs.begin() + static_cast<std::ptrdiff_t>(legs.size() / 2);
  std::nth_element(legs.begin(), middle, legs.end());
  for (const Unit& unit : Units()) {
    const double metres = *middle * unit.metres;
    if (metres >= kShortestLeg && metres <= kLongestLeg) return unit;
  }
  return std::nullopt;
}

std::optional<motion::UpAxis> FindUpAxis(const motion::Skeleton& skeleton,
                                         const std::vector<const motion::Poses*>& people) {
  motion::Vec3 up;
  for (const motion::Poses* poses : people) {
    for (int t = 0; t < poses->frame_count(); ++t) {
      const motion::Vec3 feet =
          (poses->at(t, skeleton.feet->left) + poses->at(t, skeleton.feet->right)) / 2;
      const motion::Vec3 body = poses->at(t, skeleton.root) - feet;
      if (Norm(body) > 0) up += body / Norm(body);
    }
  }
  const float most = std::max({std::abs(up.x), std::abs(up.y), std::abs(up.z)});
  if (up.y == most) return motion::UpAxis::kYUp;
  if (up.z == most) return motion::UpAxis::kZUp;
  if (-up.y == most) return motion::UpAxis::kYDown;
  return std::nullopt;
}

}  // namespace duet::importing
