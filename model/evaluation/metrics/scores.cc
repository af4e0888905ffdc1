#include "model/evaluation/metrics/scores.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "model/evaluation/metrics/displacement.h"
#include "model/evaluation/metrics/liveliness.h"
#include "model/evaluation/metrics/motion_quality.h"
#include "model/evaluation/metrics/penetration.h"
#include "model/evaluation/metrics/posture.h"
#include "model/evaluation/metrics/touch.h"

namespace duet::evaluation::metrics {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

const std::vector<Metric>& AllMetrics() {
  static const auto& metrics = *new std::vector<Metric>{
      Metric::kAfd,
      Metric::kAfdSquared,
      Metric::kAfdMetres,
      Metric::kAfdSquaredMetres,
      Metric::kRootAlignedAfd,
      Metric::kRootAlignedAfdMetres,
      Metric::kVelocityError,
      Metric::kBoneLengthDrift,
      Metric::kJitter,
      Metric::kSkatingRatio,
      Metric::kFootSlide,
      Metric::kPenetrationFrequency,
      Metric::kPenetrationDepth,
      Metric::kJointSpeed,
      Metric::kRangeOfMotion,
      Metric::kFilteredJerk,
      Metric::kLean,
      Metric::kFacing,
      Metric::kRootDistance,
      Metric::kTouch,
  };
  return metrics;
}

std::string MetricName(Metric metric) {
  switch (metric) {
    case Metric::kAfd:
      return "afd";
    case Metric::kAfdSquared:
      return "afd_squared";
    case Metric::kAfdMetres:
      return "afd_m";
    case Metric::kAfdSquaredMetres:
      return "afd_squared_m";
    case Metric::kRootAlignedAfd:
      return "root_aligned_afd";
    case Metric::kRootAlignedAfdMetres:
      return "root_aligned_afd_m";
    case Metric::kVelocityError:
      return "velocity_error";
    case Metric::kBoneLengthDrift:
      return "bone_length_drift";
    case Metric::kJitter:
      return "jitter";
    case Metric::kSkatingRatio:
      return "skating_ratio";
    case Metric::kFootSlide:
      return "foot_slide_cm";
    case Metric::kPenetrationFrequency:
      return "penetration_frequency";
    case Metric::kPenetrationDepth:
      return "penetration_depth_m";
    case Metric::kJointSpeed:
      return "joint_speed";
    case Metric::kRangeOfMotion:
      return "range_of_motion_m";
    case Metric::kFilteredJerk:
      return "filtered_jerk";
    case Metric::kLean:
      return "lean_degrees";
    case Metric::kFacing:
      return "facing_degrees";
    case Metric::kRootDistance:
      return "root_distance_m";
    case Metric::kTouch:
      return "touch";
  }
  return "";
}

std::vector<double> ScoreMotion(const dataset::Dataset& dataset, const ScoredMotion& motion) {
  const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(motion.sequence)];
  const motion::Skeleton& skeleton = dataset.skeleton;
  const motion::Poses& leader = sequence.pair.leader.poses;
  const motion::Poses& truth = sequence.pair.follower.poses;
  const motion::Poses& made = motion.follower;
  const double rate = sequence.pair.leader.frame_rate_hz;
  // The axes of the raw unit are those of the camera.
  const motion::Poses made_raw = sequence.levelling.Invert(made);
  const motion::Poses truth_raw = sequence.levelling.Invert(truth);
  const FootSlide slide = MeasureFootSlide(made, skeleton, rate);
  const motion::Poses calm = WithoutNoise(made, rate);
  const Penetration penetration = MeasurePenetration(leader, made, skeleton, dataset.parts);
  return {Afd(made_raw, truth_raw, MetricUnit::kSbuRaw),
          AfdSquared(made_raw, truth_raw, MetricUnit::kSbuRaw),
          Afd(made, truth, MetricUnit::kMetres),
          AfdSquared(made, truth, MetricUnit::kMetres),
          RootAlignedAfd(made_raw, truth_raw, skeleton.root, MetricUnit::kSbuRaw),
          RootAlignedAfd(made, truth, skeleton.root, MetricUnit::kMetres),
          VelocityError(made, truth, rate),
          BoneLengthDrift(made, skeleton),
          Jitter(made, rate),
          slide.skating_ratio,
          slide.centimetres_a_frame,
          penetration.frequency,
          penetration.frequency > 0 ? penetration.mean_depth_metres : kNone,
          JointSpeed(calm, rate),
          RangeOfMotion(calm),
          Jitter(calm, rate),
          MeasureLean(made, skeleton, rate, LeanFrom::kHips).mean_degrees,
          FacingDegrees(leader, made, skeleton),
          RootDistance(leader, made, skeleton),
          TouchShare(leader, made, skeleton, dataset.parts)};
}

std::vector<std::vector<double>> ScoreByClass(const dataset::Dataset& dataset,
                                              const std::vector<ScoredMotion>& motions) {
  const size_t metrics = AllMetrics().size();
  std::vector<std::vector<double>> sums(dataset.classes.size(), std::vector<double>(metrics));
  std::vector<std::vector<double>> counts = sums;
  for (const ScoredMotion& motion : motions) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(motion.sequence)];
    const size_t c = static_cast<size_t>(sequence.interaction_class);
    const std::vector<double> scores = ScoreMotion(dataset, motion);
    for (size_t m = 0; m < metrics; ++m) {
      // NaN: the motion has no such figure; without contact there is no depth.
      if (std::isnan(scores[m])) continue;
      sums[c][m] += scores[m];
      ++counts[c][m];
    }
  }
  for (size_t c = 0; c < sums.size(); ++c) {
    for (size_t m = 0; m < metrics; ++m) {
      sums[c][m] = counts[c][m] == 0 ? kNone : sums[c][m] / counts[c][m];
    }
  }
  return sums;
}

std::vector<ScoredMotion> CapturedMotions(const dataset::Dataset& dataset,
                                          const std::vector<int>& sequences) {
  std::vector<ScoredMotion> captured;
  for (const int index : sequences) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    captured.push_back({index, sequence.pair.follower.poses});
  }
  return captured;
}

}  // namespace duet::evaluation::metrics
