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
#include "model/motion/filter.h"

namespace duet::evaluation::metrics {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::vector<double> ScoreMotion(const dataset::Dataset& dataset, const ScoredMotion& motion) {
  const dataset::Sequence& sequence = SequenceOf(dataset, motion);
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

FiguresByMetric ScoreByClass(const dataset::Dataset& dataset,
                             const std::vector<ScoredMotion>& motions) {
  FiguresByMetric sums, counts;
  for (const char* metric : kMetrics) sums[metric].resize(dataset.classes.size());
  counts = sums;
  for (const ScoredMotion& motion : motions) {
    const auto c = static_cast<size_t>(SequenceOf(dataset, motion).interaction_class);
    const std::vector<double> scores = ScoreMotion(dataset, motion);
    for (size_t m = 0; m < scores.size(); ++m) {
      // NaN: the motion has no such figure; without contact there is no depth.
      if (std::isnan(scores[m])) continue;
      sums[kMetrics[m]][c] += scores[m];
      ++counts[kMetrics[m]][c];
    }
  }
  for (auto& [metric, figures] : sums) {
    for (size_t c = 0; c < figures.size(); ++c) {
      const double count = counts[metric][c];
      figures[c] = count == 0 ? kNone : figures[c] / count;
    }
  }
  return sums;
}

std::vector<int> ClassesOf(const dataset::Dataset& dataset, const std::vector<int>& sequences) {
  std::vector<int> classes;
  for (const int index : sequences) {
    classes.push_back(dataset.sequences[static_cast<size_t>(index)].interaction_class);
  }
  return classes;
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
