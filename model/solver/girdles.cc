#include "model/solver/girdles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/base/median.h"

namespace duet::solver {
namespace {

using motion::Vec3;

// A girdle is not quite as wide as both of its bones together: then, rounding of their lengths
// would decide on which side of it the middle joint is.
constexpr float kWidest = 0.995f;
// A middle joint nearer to the line between a girdle's ends than this is on no side of it. Metres.
constexpr float kClearSide = 0.02f;

Vec3 At(absl::Span<const Vec3> pose, int joint) { return pose[static_cast<std::size_t>(joint)]; }

// Moves a limb with its upper joint. If its end is to stay, it does as far as the limb reaches; a
// limb that is nearly straight bends towards `forward`.
void MoveLimb(const body::Limb& limb, Vec3 upper, bool end_stays, Vec3 forward,
              absl::Span<Vec3> pose) {
  const Vec3 end = At(pose, limb.end);
  const Vec3 shift = upper - At(pose, limb.upper);
  for (const int joint : {limb.upper, limb.middle, limb.end}) {
    pose[static_cast<std::size_t>(joint)] += shift;
  }
  for (const int joint : limb.beyond) pose[static_cast<std::size_t>(joint)] += shift;
  if (end_stays) body::Reach(limb, end, forward, pose);
}

}  // namespace

Girdles::Girdles(const motion::Skeleton& skeleton) {
  const body::Body body = body::FindBody(skeleton);
  hips_ = Find(skeleton, body.legs, true);
  if (body.shoulders) {
    const bool ordered = body.arms[0].upper == body.shoulders->left;
    shoulders_ = Find(
        skeleton, ordered ? body.arms : std::vector<body::Limb>{body.arms[1], body.arms[0]}, false);
  }
}

std::optional<Girdles::Girdle> Girdles::Find(const motion::Skeleton& skeleton,
                                             const std::vector<body::Limb>& limbs,
                                             bool bends_forwards) {
  if (limbs.size() != 2) return std::nullopt;
  const std::vector<int> parents = skeleton.Parents();
  const int middle = parents[static_cast<std::size_t>(limbs[0].upper)];
  if (middle < 0 || middle != parents[static_cast<std::size_t>(limbs[1].upper)]) {
    return std::nullopt;
  }
  return Girdle{middle, {limbs[0], limbs[1]}, bends_forwards};
}

float Girdles::Width(const std::optional<Girdle>& girdle, const motion::Poses& person) {
  if (!girdle) return 0;
  std::vector<float> widths;
  for (int t = 0; t < person.frame_count(); ++t) {
    widths.push_back(
        Distance(person.at(t, girdle->limbs[0].upper), person.at(t, girdle->limbs[1].upper)));
  }
  return base::Median(std::move(widths));
}

GirdleWidths Girdles::Measure(const motion::Poses& person) const {
  return {Width(hips_, person), Width(shoulders_, person)};
}

void Girdles::Spread(const Girdle& girdle, float width, Vec3 trunk, bool ends_stay,
                     absl::Span<Vec3> pose) {
  const Vec3 from = At(pose, girdle.middle);
  const Vec3 left = At(pose, girdle.limbs[0].upper), right = At(pose, girdle.limbs[1].upper);
  const float a = Distance(from, left), b = Distance(from, right), now = Distance(left, right);
  const float wide = std::clamp(width, std::abs(a - b), kWidest * (a + b));
  if (now <= 0 || wide <= 0) return;
  const Vec3 across = (left - right) / now;
  // The triangle of both bones and the width, in its own plane.
  const float along = (a * a - b * b + wide * wide) / (2 * wide);
  const float down = std::sqrt(std::max(0.0f, a * a - along * along));
  Vec3 hanging = left - from - across * Dot(left - from, across);
  // Shoulders in one line with the neck hang down the trunk.
  hanging += (trunk - across * Dot(trunk, across)) * std::max(0.0f, kClearSide - Norm(hanging));
  const float length = Norm(hanging);
  if (length <= 0) return;
  const Vec3 middle = from + hanging * (down / length);
  // Knees bend forwards, elbows backwards.
  const Vec3 facing = Cross(across, Vec3{0, 1, 0});
  const Vec3 bend = girdle.bends_forwards ? facing : -facing;
  MoveLimb(girdle.limbs[0], middle + across * along, ends_stay, bend, pose);
  MoveLimb(girdle.limbs[1], middle + across * (along - wide), ends_stay, bend, pose);
}

void Girdles::Spread(const GirdleWidths& widths, bool ends_stay, absl::Span<Vec3> pose) const {
  Vec3 trunk;  // downwards, of length 1; nothing for a skeleton with one girdle
  if (hips_ && shoulders_) trunk = At(pose, hips_->middle) - At(pose, shoulders_->middle);
  if (const float length = Norm(trunk); length > 0) trunk = trunk / length;
  if (hips_ && widths.hips > 0) Spread(*hips_, widths.hips, trunk, ends_stay, pose);
  if (shoulders_ && widths.shoulders > 0) {
    Spread(*shoulders_, widths.shoulders, trunk, ends_stay, pose);
  }
}

void Girdles::Apply(const GirdleWidths& widths, absl::Span<Vec3> pose) const {
  Spread(widths, /*ends_stay=*/false, pose);
}

void Girdles::ApplyAboveFeet(const GirdleWidths& widths, absl::Span<Vec3> pose) const {
  Spread(widths, /*ends_stay=*/true, pose);
}

}  // namespace duet::solver
