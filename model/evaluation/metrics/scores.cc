#include "model/evaluation/metrics/scores.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "model/base/statistics.h"
#include "model/body/contact.h"
#include "model/body/liveliness.h"
#include "model/body/motion_quality.h"
#include "model/body/posture.h"
#include "model/motion/coordinates.h"
#include "model/motion/filter.h"

namespace duet::evaluation::metrics {
namespace {

// Uses the data set's own conversion, so that its constants are defined once.
motion::Vec3 InUnit(MetricUnit unit, motion::Vec3 metres) {
  if (unit == MetricUnit::kMetres) return metres;
  return FromWorld({motion::LengthUnit::kSbuNormalised, motion::UpAxis::kYDown}, metres);
}

double SquaredDistance(motion::Vec3 a, motion::Vec3 b) {
  const double x = double{a.x} - b.x, y = double{a.y} - b.y, z = double{a.z} - b.z;
  return x * x + y * y + z * z;
}

// The squared norm of x^_t - x_t over all coordinates of a frame.
double FrameSquared(absl::Span<const motion::Vec3> predicted, absl::Span<const motion::Vec3> truth,
                    MetricUnit unit) {
  double squared = 0;
  for (size_t j = 0; j < truth.size(); ++j) {
    squared += SquaredDistance(InUnit(unit, predicted[j]), InUnit(unit, truth[j]));
  }
  return squared;
}

motion::Poses WithoutRoot(motion::Poses poses, int root) {
  for (int t = 0; t < poses.frame_count(); ++t) {
    const motion::Vec3 at = poses.at(t, root);
    for (motion::Vec3& position : poses[t]) position = position - at;
  }
  return poses;
}

size_t MotionCount(const SampledMotions& samples) {
  return samples.empty() ? 0 : samples.front().size();
}

// Between two followers of a sequence, in the world as captured, to which the raw unit refers.
double Distance(const dataset::Sequence& sequence, const motion::Poses& a, const motion::Poses& b) {
  return Afd(sequence.levelling.Invert(a), sequence.levelling.Invert(b), MetricUnit::kSbuRaw);
}

// The mean afd between any two answers to leader `i`.
double Spread(const dataset::Dataset& dataset, const SampledMotions& samples, size_t i) {
  double sum = 0, pairs = 0;
  for (size_t a = 0; a < samples.size(); ++a) {
    for (size_t b = 0; b < a; ++b) {
      sum += Distance(SequenceOf(dataset, samples[a][i]), samples[a][i].follower,
                      samples[b][i].follower);
      ++pairs;
    }
  }
  return pairs == 0 ? 0 : sum / pairs;
}

}  // namespace

double Afd(const motion::Poses& predicted, const motion::Poses& truth, MetricUnit unit) {
  double sum = 0;
  for (int t = 0; t < truth.frame_count(); ++t) {
    sum += std::sqrt(FrameSquared(predicted[t], truth[t], unit));
  }
  return sum / truth.frame_count();
}

double AfdSquared(const motion::Poses& predicted, const motion::Poses& truth) {
  double sum = 0;
  for (int t = 0; t < truth.frame_count(); ++t) {
    sum += FrameSquared(predicted[t], truth[t], MetricUnit::kSbuRaw);
  }
  return sum / truth.frame_count();
}

double RootAlignedAfd(const motion::Poses& predicted, const motion::Poses& truth, int root) {
  return Afd(WithoutRoot(predicted, root), WithoutRoot(truth, root), MetricUnit::kSbuRaw);
}

std::map<std::string, double> ScoreMotion(const dataset::Dataset& dataset,
                                          const ScoredMotion& motion) {
  const dataset::Sequence& sequence = SequenceOf(dataset, motion);
  const motion::Skeleton& skeleton = dataset.skeleton;
  const motion::Poses& leader = sequence.pair.leader.poses;
  const motion::Poses& truth = sequence.pair.follower.poses;
  const motion::Poses& made = motion.follower;
  const double rate = sequence.pair.leader.frame_rate_hz;
  // The axes of the raw unit are those of the camera.
  const motion::Poses made_raw = sequence.levelling.Invert(made);
  const motion::Poses truth_raw = sequence.levelling.Invert(truth);
  const body::FootSlide slide = body::MeasureFootSlide(made, skeleton, rate);
  const motion::Poses calm = WithoutNoise(made, rate);
  const body::Penetration penetration =
      body::MeasurePenetration(leader, made, skeleton, dataset.parts);
  return {
      {"afd", Afd(made_raw, truth_raw, MetricUnit::kSbuRaw)},
      {"afd_squared", AfdSquared(made_raw, truth_raw)},
      {"afd_m", Afd(made, truth, MetricUnit::kMetres)},
      {"root_aligned_afd", RootAlignedAfd(made_raw, truth_raw, skeleton.root)},
      {"velocity_error", body::VelocityError(made, truth, rate)},
      {"bone_length_drift", body::BoneLengthDrift(made, skeleton)},
      {"jitter", body::Jitter(made, rate)},
      {"skating_ratio", slide.skating_ratio},
      {"foot_slide_cm", slide.centimetres_a_frame},
      {"penetration_frequency", penetration.frequency},
      {"penetration_depth_m", penetration.frequency > 0 ? penetration.mean_depth_metres : NAN},
      {"joint_speed", body::JointSpeed(calm, rate)},
      {"range_of_motion_m", body::RangeOfMotion(calm)},
      {"lean_degrees", body::MeasureLean(made, skeleton, rate, body::LeanFrom::kHips).mean_degrees},
      {"facing_degrees", body::FacingDegrees(leader, made, skeleton)},
      {"root_distance_m", body::RootDistance(leader, made, skeleton)},
      {"touch", body::TouchShare(leader, made, skeleton, dataset.parts)}};
}

FiguresByMetric ScoreByClass(const dataset::Dataset& dataset,
                             const std::vector<ScoredMotion>& motions) {
  std::map<std::string, std::vector<std::vector<double>>> scores;  // [classes][motions] each
  for (const ScoredMotion& motion : motions) {
    const auto c = static_cast<size_t>(SequenceOf(dataset, motion).interaction_class);
    for (const auto& [metric, score] : ScoreMotion(dataset, motion)) {
      scores[metric].resize(dataset.classes.size());
      scores[metric][c].push_back(score);
    }
  }
  FiguresByMetric figures;
  for (const auto& [metric, by_class] : scores) {
    // NaN: the motion has no such figure; without contact there is no depth.
    for (const auto& of_class : by_class) figures[metric].push_back(base::Mean(of_class));
  }
  return figures;
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

std::vector<ScoredMotion> Pool(const SampledMotions& samples) {
  std::vector<ScoredMotion> all;
  for (const std::vector<ScoredMotion>& set : samples) {
    all.insert(all.end(), set.begin(), set.end());
  }
  return all;
}

std::vector<ScoredMotion> MeanAnswers(const SampledMotions& samples) {
  std::vector<ScoredMotion> means;
  const float share = 1 / static_cast<float>(samples.size());
  for (size_t i = 0; i < MotionCount(samples); ++i) {
    ScoredMotion mean = samples.front()[i];
    for (size_t p = 0; p < mean.follower.all().size(); ++p) {
      motion::Vec3 sum;
      for (const std::vector<ScoredMotion>& set : samples) sum += set[i].follower.all()[p];
      mean.follower.all()[p] = share * sum;
    }
    means.push_back(std::move(mean));
  }
  return means;
}

std::vector<ScoredMotion> BestAnswers(const dataset::Dataset& dataset,
                                      const SampledMotions& samples) {
  std::vector<ScoredMotion> answers;
  for (size_t i = 0; i < MotionCount(samples); ++i) {
    const ScoredMotion* best = &samples.front()[i];
    double least = std::numeric_limits<double>::infinity();
    for (const std::vector<ScoredMotion>& set : samples) {
      const dataset::Sequence& sequence = SequenceOf(dataset, set[i]);
      const double distance = Distance(sequence, set[i].follower, sequence.pair.follower.poses);
      if (distance >= least) continue;
      best = &set[i];
      least = distance;
    }
    answers.push_back(*best);
  }
  return answers;
}

std::vector<double> MultimodalityByClass(const dataset::Dataset& dataset,
                                         const SampledMotions& samples) {
  std::vector<double> sums(dataset.classes.size()), counts(dataset.classes.size());
  for (size_t i = 0; i < MotionCount(samples); ++i) {
    const auto c = static_cast<size_t>(SequenceOf(dataset, samples.front()[i]).interaction_class);
    sums[c] += Spread(dataset, samples, i);
    ++counts[c];
  }
  for (size_t c = 0; c < sums.size(); ++c) {
    sums[c] /= counts[c];  // NaN without any
  }
  return sums;
}

}  // namespace duet::evaluation::metrics
