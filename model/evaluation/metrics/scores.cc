#include "model/evaluation/metrics/scores.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "model/base/statistics.h"
#include "model/body/contact.h"
#include "model/body/liveliness.h"
#include "model/body/motion_quality.h"
#include "model/body/posture.h"
#include "model/motion/coordinates.h"
#include "model/motion/filter.h"

namespace duet::evaluation::metrics {
namespace {

double SquaredDistance(motion::Vec3 a, motion::Vec3 b) {
  const double x = double{a.x} - b.x, y = double{a.y} - b.y, z = double{a.z} - b.z;
  return x * x + y * y + z * z;
}

// The squared norm of x^_t - x_t over all coordinates of a frame.
double FrameSquared(absl::Span<const motion::Vec3> predicted,
                    absl::Span<const motion::Vec3> truth) {
  double squared = 0;
  for (size_t j = 0; j < truth.size(); ++j) squared += SquaredDistance(predicted[j], truth[j]);
  return squared;
}

// Between two followers of a sequence, in the world as captured, to which the raw unit refers.
double Distance(const dataset::Sequence& sequence, const motion::Poses& a, const motion::Poses& b) {
  return Afd(ToRaw(sequence.levelling.Invert(a)), ToRaw(sequence.levelling.Invert(b)));
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

double SquaredDistance(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double difference = double{a[i]} - double{b[i]};
    sum += difference * difference;
  }
  return sum;
}

// A Gaussian as its mean and a factor R with covariance R^T R.
struct Gaussian {
  Eigen::RowVectorXd mean;
  Eigen::MatrixXd factor;  // [samples, features]
};

Gaussian Fit(const FeatureSet& features) {
  const Eigen::Index samples = static_cast<Eigen::Index>(features.size());
  const Eigen::Index width = static_cast<Eigen::Index>(features[0].size());
  Eigen::MatrixXd rows(samples, width);
  for (Eigen::Index i = 0; i < samples; ++i) {
    rows.row(i) =
        Eigen::Map<const Eigen::RowVectorXf>(features[static_cast<size_t>(i)].data(), width)
            .cast<double>();
  }
  const Eigen::RowVectorXd mean = rows.colwise().mean();
  return {mean, (rows.rowwise() - mean) / std::sqrt(static_cast<double>(samples - 1))};
}

// Fewer motions have neither a covariance nor a pair.
constexpr size_t kLeastMotions = 2;

FeatureSet OfClass(const JudgedFold& fold, int wanted) {
  FeatureSet features;
  for (size_t i = 0; i < fold.classes.size(); ++i) {
    if (fold.classes[i] == wanted) features.push_back(fold.features[i]);
  }
  return features;
}

// The mean over the folds whose two sets, selected by `select`, have enough motions.
template <typename Select>
double MeanFrechet(const std::vector<JudgedFold>& made, const std::vector<JudgedFold>& captured,
                   Select select) {
  std::vector<double> distances;
  for (size_t fold = 0; fold < made.size(); ++fold) {
    const FeatureSet a = select(made[fold]), b = select(captured[fold]);
    if (std::min(a.size(), b.size()) >= kLeastMotions) distances.push_back(FrechetDistance(a, b));
  }
  return base::Mean(distances);
}

}  // namespace

motion::Poses ToRaw(motion::Poses metres) {
  // The data set's own conversion, so that its constants are defined once.
  constexpr motion::Coordinates kRaw = {motion::LengthUnit::kSbuNormalised, motion::UpAxis::kYDown};
  for (motion::Vec3& position : metres.all()) position = FromWorld(kRaw, position);
  return metres;
}

double Afd(const motion::Poses& predicted, const motion::Poses& truth) {
  double sum = 0;
  for (int t = 0; t < truth.frame_count(); ++t) {
    sum += std::sqrt(FrameSquared(predicted[t], truth[t]));
  }
  return sum / truth.frame_count();
}

double AfdSquared(const motion::Poses& predicted, const motion::Poses& truth) {
  double sum = 0;
  for (int t = 0; t < truth.frame_count(); ++t) sum += FrameSquared(predicted[t], truth[t]);
  return sum / truth.frame_count();
}

motion::Poses WithoutRoot(motion::Poses poses, int root) {
  for (int t = 0; t < poses.frame_count(); ++t) {
    const motion::Vec3 at = poses.at(t, root);
    for (motion::Vec3& position : poses[t]) position = position - at;
  }
  return poses;
}

motion::Standardisation StandardOf(const motion::Skeleton& skeleton,
                                   const dataset::Sequence& sequence,
                                   motion::StandardOrigin origin) {
  const motion::Poses& leader = sequence.pair.leader.poses;
  if (sequence.partner_direction) {
    return {skeleton, leader, FacingYaw(*sequence.partner_direction), origin};
  }
  return {skeleton, leader, motion::YawDirection::kRemove, origin};
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
  const motion::Poses made_seen = sequence.levelling.Invert(made);
  const motion::Poses truth_seen = sequence.levelling.Invert(truth);
  const body::FootSlide slide = body::MeasureFootSlide(made, skeleton, rate);
  const motion::Poses calm = WithoutNoise(made, rate);
  const body::Penetration penetration =
      body::MeasurePenetration(leader, made, skeleton, dataset.parts);
  return {
      {"afd", Afd(ToRaw(made_seen), ToRaw(truth_seen))},
      {"afd_squared", AfdSquared(ToRaw(made_seen), ToRaw(truth_seen))},
      {"afd_m", Afd(made, truth)},
      {"root_aligned_afd", Afd(ToRaw(WithoutRoot(made_seen, skeleton.root)),
                               ToRaw(WithoutRoot(truth_seen, skeleton.root)))},
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
  for (size_t i = 0; i < samples.front().size(); ++i) {
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
  for (size_t i = 0; i < samples.front().size(); ++i) {
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
  for (size_t i = 0; i < samples.front().size(); ++i) {
    const auto c = static_cast<size_t>(SequenceOf(dataset, samples.front()[i]).interaction_class);
    sums[c] += Spread(dataset, samples, i);
    ++counts[c];
  }
  for (size_t c = 0; c < sums.size(); ++c) {
    sums[c] /= counts[c];  // NaN without any
  }
  return sums;
}

double FrechetDistance(const FeatureSet& a, const FeatureSet& b) {
  const Gaussian first = Fit(a), second = Fit(b);
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(first.factor * second.factor.transpose());
  const double distance = (first.mean - second.mean).squaredNorm() + first.factor.squaredNorm() +
                          second.factor.squaredNorm() - 2 * svd.singularValues().sum();
  return std::max(0.0, distance);
}

double Diversity(const FeatureSet& features) {
  double sum = 0, pairs = 0;
  for (size_t i = 0; i < features.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      sum += std::sqrt(SquaredDistance(features[i], features[j]));
      ++pairs;
    }
  }
  return pairs == 0 ? 0 : sum / pairs;
}

double NeighbourAccuracy(const FeatureSet& features, const std::vector<int>& classes) {
  if (features.size() < kLeastMotions) return NAN;
  double right = 0;
  for (size_t i = 0; i < features.size(); ++i) {
    size_t nearest = i == 0 ? 1 : 0;
    for (size_t other = 0; other < features.size(); ++other) {
      if (other != i && SquaredDistance(features[i], features[other]) <
                            SquaredDistance(features[i], features[nearest])) {
        nearest = other;
      }
    }
    if (classes[nearest] == classes[i]) ++right;
  }
  return right / static_cast<double>(features.size());
}

std::vector<double> AccuracyByClass(const std::vector<JudgedFold>& folds, int classes) {
  std::vector<double> right(static_cast<size_t>(classes)), all(right.size());
  for (const JudgedFold& fold : folds) {
    for (size_t i = 0; i < fold.classes.size(); ++i) {
      const std::vector<float>& one = fold.probabilities[i];
      const auto likeliest = std::max_element(one.begin(), one.end()) - one.begin();
      const auto meant = static_cast<size_t>(fold.classes[i]);
      if (static_cast<size_t>(likeliest) == meant) ++right[meant];
      ++all[meant];
    }
  }
  for (size_t c = 0; c < right.size(); ++c) right[c] /= all[c];
  return right;
}

std::vector<double> FrechetByClass(const std::vector<JudgedFold>& made,
                                   const std::vector<JudgedFold>& captured, int classes) {
  std::vector<double> distances;
  for (int c = 0; c < classes; ++c) {
    distances.push_back(
        MeanFrechet(made, captured, [c](const JudgedFold& fold) { return OfClass(fold, c); }));
  }
  return distances;
}

double PooledFrechet(const std::vector<JudgedFold>& made, const std::vector<JudgedFold>& captured) {
  return MeanFrechet(made, captured, [](const JudgedFold& fold) { return fold.features; });
}

std::vector<double> DiversityByClass(const std::vector<JudgedFold>& folds, int classes) {
  std::vector<double> diversities;
  for (int c = 0; c < classes; ++c) {
    std::vector<double> of_folds;
    for (const JudgedFold& fold : folds) {
      const FeatureSet features = OfClass(fold, c);
      if (features.size() >= kLeastMotions) of_folds.push_back(Diversity(features));
    }
    diversities.push_back(base::Mean(of_folds));
  }
  return diversities;
}

}  // namespace duet::evaluation::metrics
