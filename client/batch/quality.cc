#include "client/batch/quality.h"

#include <cmath>

#include "absl/strings/str_format.h"
#include "model/cleanup/floor.h"
#include "model/cleanup/limbs.h"
#include "model/evaluation/metrics/liveliness.h"
#include "model/evaluation/metrics/penetration.h"
#include "model/evaluation/metrics/posture.h"

namespace duet::client::batch {
namespace {

namespace metrics = evaluation::metrics;

std::optional<double> Known(double figure) {
  return std::isnan(figure) ? std::nullopt : std::optional<double>(figure);
}

}  // namespace

Quality Measure(const motion::ClipPair& pair, const motion::Skeleton& skeleton) {
  const motion::Poses& leader = pair.leader.poses;
  const motion::Poses& follower = pair.follower.poses;
  Quality quality;
  quality.lean_degrees = Known(metrics::MeasureLean(follower, skeleton, pair.follower.frame_rate_hz,
                                                    metrics::LeanFrom::kHips)
                                   .max_degrees);
  if (skeleton.feet.has_value()) {
    const metrics::FloorGap gap =
        metrics::MeasureFloorGap(follower, skeleton, cleanup::FloorHeight(*skeleton.feet, leader));
    quality.foot_above_floor_metres = gap.above;
    quality.foot_below_floor_metres = gap.below;
  }
  quality.distance_metres = metrics::RootDistance(leader, follower, skeleton);
  quality.penetration_metres =
      metrics::MeasurePenetration(leader, follower, skeleton,
                                  cleanup::LimbParts(cleanup::FindBody(skeleton)))
          .max_depth_metres;
  quality.range_of_motion_metres = metrics::RangeOfMotion(follower);
  return quality;
}

std::vector<std::string> WhyRejected(const QualityFilter& filter, const Quality& quality,
                                     const std::optional<double>& unfamiliarity) {
  std::vector<std::string> reasons;
  const auto at_most = [&reasons](const char* name, const std::optional<double>& figure,
                                  const std::optional<double>& limit) {
    if (!figure || !limit || *figure <= *limit) return;
    reasons.push_back(absl::StrFormat("%s %.4g, wanted at most %g", name, *figure, *limit));
  };
  const auto at_least = [&reasons](const char* name, double figure,
                                   const std::optional<double>& limit) {
    if (!limit || figure >= *limit) return;
    reasons.push_back(absl::StrFormat("%s %.4g, wanted at least %g", name, figure, *limit));
  };
  at_most("lean_degrees", quality.lean_degrees, filter.max_lean_degrees);
  at_most("foot_above_floor_metres", quality.foot_above_floor_metres,
          filter.max_foot_above_floor_metres);
  at_most("foot_below_floor_metres", quality.foot_below_floor_metres,
          filter.max_foot_below_floor_metres);
  at_least("distance_metres", quality.distance_metres, filter.min_distance_metres);
  at_most("distance_metres", quality.distance_metres, filter.max_distance_metres);
  at_most("penetration_metres", quality.penetration_metres, filter.max_penetration_metres);
  at_least("range_of_motion_metres", quality.range_of_motion_metres,
           filter.min_range_of_motion_metres);
  at_most("unfamiliarity", unfamiliarity, filter.max_unfamiliarity);
  return reasons;
}

}  // namespace duet::client::batch
