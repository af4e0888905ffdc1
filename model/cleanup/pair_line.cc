#include "model/cleanup/pair_line.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "model/base/median.h"
#include "model/cleanup/directions.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr float kDegree = 0.01745329252f;

}  // namespace

PairLine Describe(const TrunkAxes& axes, Vec3 across) {
  const float left = Dot(across, axes.left), behind = Dot(across, axes.behind);
  PairLine line;
  line.reversed = left < 0;
  line.turn = std::atan2(behind, std::abs(left)) / kDegree;
  line.width = Norm(across);
  line.tilt = std::asin(std::clamp(Dot(across, axes.down) / line.width, -1.0f, 1.0f)) / kDegree;
  return line;
}

PlacedPair PlacePair(const TrunkAxes& axes, const PairLine& line, Vec3 from, Vec3 towards,
                     float to_left, float to_right) {
  const float c = std::cos(line.turn * kDegree), s = std::sin(line.turn * kDegree);
  const Vec3 level = axes.left * c + axes.behind * s;
  const float ct = std::cos(line.tilt * kDegree), st = std::sin(line.tilt * kDegree);
  const Vec3 along = level * ct + axes.down * st;
  const Vec3 across = towards - along * Dot(towards, along);
  const Vec3 down =
      Norm(across) > kNoDirection ? across / Norm(across) : axes.down * ct - level * st;
  // A triangle with these three sides, as wide as the bones allow.
  const float width = std::clamp(line.width, std::abs(to_left - to_right), to_left + to_right);
  if (width < kNoDirection) return {from + down * to_left, from + down * to_right};
  const float a = (to_left * to_left - to_right * to_right + width * width) / (2 * width);
  const float depth = std::sqrt(std::max(0.0f, to_left * to_left - a * a));
  const Vec3 left = from + down * depth + along * a;
  return {left, left - along * width};
}

float MedianWidth(const motion::JointPair& pair, const motion::Poses& poses, int frames) {
  std::vector<float> widths;
  for (int t = 0; t < frames; ++t) {
    widths.push_back(Distance(poses.at(t, pair.left), poses.at(t, pair.right)));
  }
  return base::Median(std::move(widths));
}

float Within(const SoftRange& range, float degrees) {
  const float limited =
      SoftLimit(std::abs(degrees), static_cast<float>(range.free), static_cast<float>(range.most));
  return std::copysign(limited, degrees);
}

}  // namespace duet::cleanup
