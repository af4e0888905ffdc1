#include "client/batch/quality.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "model/body/limbs.h"
#include "model/body/liveliness.h"
#include "model/body/penetration.h"
#include "model/body/posture.h"
#include "model/motion/feet.h"

namespace duet::client::batch {
namespace {

std::optional<double> Known(double figure) {
  return std::isnan(figure) ? std::nullopt : std::optional<double>(figure);
}

// The clip reduced to these joints, in this order.
motion::Clip InJoints(const motion::Clip& clip, const std::vector<std::string>& joints) {
  if (clip.joint_names == joints) return clip;
  std::vector<int> from;
  for (const std::string& joint : joints) {
    const auto found = std::find(clip.joint_names.begin(), clip.joint_names.end(), joint);
    from.push_back(static_cast<int>(found - clip.joint_names.begin()));
  }
  motion::Clip out;
  out.joint_names = joints;
  out.frame_rate_hz = clip.frame_rate_hz;
  out.poses = motion::Poses(clip.frame_count(), static_cast<int>(joints.size()));
  for (int t = 0; t < clip.frame_count(); ++t) {
    for (size_t j = 0; j < from.size(); ++j) out.at(t, static_cast<int>(j)) = clip.at(t, from[j]);
  }
  return out;
}

}  // namespace

Quality Measure(const motion::ClipPair& pair, const motion::Skeleton& skeleton) {
  const motion::Poses& leader = pair.leader.poses;
  const motion::Poses& follower = pair.follower.poses;
  Quality quality;
  quality.lean_degrees = Known(
      body::MeasureLean(follower, skeleton, pair.follower.frame_rate_hz, body::LeanFrom::kHips)
          .max_degrees);
  if (skeleton.feet.has_value()) {
    const body::FloorGap gap =
        body::MeasureFloorGap(follower, skeleton, motion::FloorHeight(*skeleton.feet, leader));
    quality.foot_above_floor_metres = gap.above;
    quality.foot_below_floor_metres = gap.below;
  }
  quality.distance_metres = body::RootDistance(leader, follower, skeleton);
  quality.penetration_metres = body::MeasurePenetration(leader, follower, skeleton,
                                                        body::LimbParts(body::FindBody(skeleton)))
                                   .max_depth_metres;
  quality.range_of_motion_metres = body::RangeOfMotion(follower);
  return quality;
}

void Recognise(const classifier::Classifier& classifier, const std::string& wanted,
               const motion::ClipPair& pair, Quality* quality) {
  const classifier::ClassifierParts& parts = classifier.parts();
  const auto known = std::find(parts.classes.begin(), parts.classes.end(), wanted);
  if (known == parts.classes.end()) return;
  const std::vector<std::string>& joints = parts.skeleton.joint_names;
  const std::vector<float> probabilities =
      classifier.Probabilities({InJoints(pair.leader, joints), InJoints(pair.follower, joints)});
  const auto best = std::max_element(probabilities.begin(), probabilities.end());
  quality->recognised_class = parts.classes[static_cast<size_t>(best - probabilities.begin())];
  quality->class_probability = probabilities[static_cast<size_t>(known - parts.classes.begin())];
}

std::vector<std::string> WhyRejected(const QualityFilter& filter, const Quality& quality,
                                     const std::optional<double>& unfamiliarity) {
  std::vector<std::string> reasons;
  const auto at_most = [&reasons](const char* name, const std::optional<double>& figure,
                                  const std::optional<double>& limit) {
    if (!figure || !limit || *figure <= *limit) return;
    reasons.push_back(absl::StrFormat("%s: expected at most %g, got %.4g", name, *limit, *figure));
  };
  const auto at_least = [&reasons](const char* name, double figure,
                                   const std::optional<double>& limit) {
    if (!limit || figure >= *limit) return;
    reasons.push_back(absl::StrFormat("%s: expected at least %g, got %.4g", name, *limit, figure));
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
  if (quality.class_probability) {
    at_least("class_probability", *quality.class_probability, filter.min_class_probability);
  }
  if (quality.grade) {
    at_most("twisted", quality.grade->twisted, filter.max_twisted);
    at_most("overlapping", quality.grade->overlapping, filter.max_overlapping);
    at_most("skating_over_leader", quality.grade->skating - quality.grade->leader_skating,
            filter.max_skating_over_leader);
  }
  at_most("unfamiliarity", unfamiliarity, filter.max_unfamiliarity);
  return reasons;
}

}  // namespace duet::client::batch
