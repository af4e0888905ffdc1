#include "model/body/build.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "model/base/angle.h"
#include "model/base/median.h"
#include "model/base/statistics.h"
#include "model/body/liveliness.h"
#include "model/motion/filter.h"

namespace duet::body {
namespace {

using motion::Vec3;

constexpr double kWidestShare = 0.9;  // the quantile of the distance of the feet

double BendDegrees(const Limb& limb, absl::Span<const Vec3> pose) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  const Vec3 upper = at(limb.middle) - at(limb.upper), lower = at(limb.end) - at(limb.middle);
  const double lengths = double{Norm(upper)} * Norm(lower);
  if (lengths <= 0) return 0;
  return std::acos(std::clamp(Dot(upper, lower) / lengths, -1.0, 1.0)) * base::kDegreesPerRadian;
}

}  // namespace

double BuildFigures::HipsOff() const { return std::max(widest_hips - 1, 1 - narrowest_hips); }

BuildFigures MeasureBuild(const motion::Skeleton& skeleton, const Body& body,
                          const motion::Poses& person) {
  const motion::JointPair hips = *skeleton.hips, feet = *skeleton.feet;
  std::vector<double> widths;
  BuildFigures figures;
  const double frames = person.frame_count();
  for (int t = 0; t < person.frame_count(); ++t) {
    widths.push_back(Distance(person.at(t, hips.left), person.at(t, hips.right)));
    double length = 0;
    for (const Limb& leg : body.legs) {
      figures.knee_degrees += BendDegrees(leg, person[t]) / (2 * frames);
      length += LengthOf(leg, person[t]) / 2;
    }
    const float lower = std::min(person.at(t, feet.left).y, person.at(t, feet.right).y);
    const float height = (person.at(t, hips.left).y + person.at(t, hips.right).y) / 2 - lower;
    if (length > 0) figures.hips_over_leg += height / length / frames;
  }
  const double width = base::Median(widths);
  if (width <= 0) return figures;
  const auto [narrowest, widest] = std::minmax_element(widths.begin(), widths.end());
  figures.narrowest_hips = *narrowest / width;
  figures.widest_hips = *widest / width;
  return figures;
}

StillnessFigures MeasureStillness(const motion::Skeleton& skeleton, const Body& body,
                                  const motion::Poses& person, double frame_rate_hz) {
  const motion::JointPair feet = *skeleton.feet;
  std::vector<double> apart;
  int raised = 0;
  for (int t = 0; t < person.frame_count(); ++t) {
    raised += std::any_of(body.arms.begin(), body.arms.end(), [&](const Limb& arm) {
      return person.at(t, arm.end).y > person.at(t, arm.upper).y;
    });
    const Vec3 between = person.at(t, feet.left) - person.at(t, feet.right);
    apart.push_back(std::hypot(double{between.x}, double{between.z}));
  }
  return {JointSpeed(motion::WithoutNoise(person, frame_rate_hz), frame_rate_hz),
          static_cast<double>(raised) / person.frame_count(), base::Quantile(apart, kWidestShare)};
}

}  // namespace duet::body
