#include "model/evaluation/baselines/baselines.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/base/random.h"
#include "model/base/status_macros.h"

namespace duet::evaluation::baselines {
namespace {

constexpr auto kEveryFrame = motion::StandardOrigin::kEveryFrame;
constexpr auto kFirstFrame = motion::StandardOrigin::kFirstFrame;

using FloatRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Entry {
  const char* name;
  // Learns a model of each class; null: holds the follower's first pose.
  ClassModel (*learn)(const std::vector<StandardPair>& pairs);
};

constexpr Entry kBaselines[] = {
    {"class_mean", LearnClassMean},
    {"frozen_first_frame", nullptr},
    {"nearest_neighbour", LearnNearestNeighbour},
    {"hmm", LearnHmm},
    {"kzbh12", LearnDiscreteMdp},
    {"hk14", LearnKernelRl},
    {"hfkb15", LearnMaxEntIoc},
};

// Shapes: returns [classes].
absl::StatusOr<std::vector<ClassModel>> LearnClasses(const Entry& entry,
                                                     const dataset::Dataset& dataset,
                                                     const std::vector<int>& train) {
  std::vector<std::vector<StandardPair>> by_class(dataset.classes.size());
  for (const int i : train) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(i)];
    by_class[static_cast<size_t>(sequence.interaction_class)].push_back(
        StandardiseSequence(dataset.skeleton, sequence));
  }
  std::vector<ClassModel> models;
  for (size_t c = 0; c < by_class.size(); ++c) {
    if (by_class[c].empty()) {
      return absl::InvalidArgumentError(absl::StrCat(entry.name,
                                                     ": expected a training sequence of class ",
                                                     dataset.classes[c], ", got none"));
    }
    models.push_back(entry.learn(by_class[c]));
  }
  return models;
}

// The captured followers of a class that can answer a clip of `frames` frames.
std::vector<const dataset::Sequence*> Candidates(const dataset::Dataset& dataset,
                                                 const std::vector<int>& train,
                                                 int interaction_class, int frames) {
  std::vector<const dataset::Sequence*> all, enough;
  for (const int index : train) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    if (sequence.interaction_class != interaction_class) continue;
    all.push_back(&sequence);
    if (sequence.pair.leader.frame_count() >= frames) enough.push_back(&sequence);
  }
  return enough.empty() ? all : enough;
}

// Frames on either side over which a velocity is measured.
constexpr Eigen::Index kVelocityReach = 2;
// Metres that correspond to the whole duration, relative to a pose of 3 J coordinates.
constexpr double kTimeWeight = 1.0;
// Weight of one metre of the root's path, which moves all joints.
constexpr double kWayWeight = 2.0;

// Components with less than this share of the strongest one's variance are rounding.
constexpr double kNoVariance = 1e-10;

Rows LeaderCues(const motion::Standardisation& frame, const motion::Poses& world) {
  const Rows pose = ToRows(frame.Apply(world));
  const Eigen::Index frames = pose.rows(), width = pose.cols();
  Rows cues(frames, 2 * width + 4);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const Eigen::Index before = std::max<Eigen::Index>(t - kVelocityReach, 0);
    const Eigen::Index after = std::min(t + kVelocityReach, frames - 1);
    cues.row(t).head(width) = pose.row(t);
    cues.row(t).segment(width, width) = pose.row(after) - pose.row(before);
    // For any joint, its coordinates in this frame's system and in the first frame's differ by the
    // root's movement.
    const motion::Vec3 way =
        frame.Apply(world.at(static_cast<int>(t), 0)) -
        motion::Vec3{static_cast<float>(pose(t, 0)), static_cast<float>(pose(t, 1)),
                     static_cast<float>(pose(t, 2))};
    cues.row(t).segment(2 * width, 3) = kWayWeight * Eigen::RowVector3d(way.x, way.y, way.z);
    cues(t, 2 * width + 3) = kTimeWeight * static_cast<double>(t) /
                             static_cast<double>(std::max<Eigen::Index>(frames - 1, 1));
  }
  return cues;
}

constexpr int kMaxIterations = 100;

// Picks rows with probability proportional to the squared distance to those picked before.
Rows Seeds(const Rows& rows, int clusters, base::Random* random) {
  Rows centres(clusters, rows.cols());
  Eigen::VectorXd nearest =
      Eigen::VectorXd::Constant(rows.rows(), std::numeric_limits<double>::infinity());
  Eigen::Index pick =
      static_cast<Eigen::Index>(random->Uniform() * static_cast<double>(rows.rows()));
  int count = 0;
  while (count < clusters) {
    centres.row(count++) = rows.row(pick);
    nearest = nearest.cwiseMin((rows.rowwise() - rows.row(pick)).rowwise().squaredNorm());
    if (nearest.sum() <= 0) break;
    pick = SampleIndex(nearest, random);
  }
  return centres.topRows(count);
}

// A matching's cost so far and its number of matched rows.
struct Path {
  double cost = std::numeric_limits<double>::infinity();
  int length = 0;
};

const Path& Cheapest(const Path& a, const Path& b, const Path& c) {
  const Path& ab = a.cost <= b.cost ? a : b;
  return ab.cost <= c.cost ? ab : c;
}

// The mean distance of matched rows along the best monotone matching of two motions (dynamic time
// warping: steps in either or both; first and last rows are matched).
double TimeWarpedDistance(const Rows& a, const Rows& b) {
  const size_t width = static_cast<size_t>(b.rows());
  // One row of the table at a time; index 0 stands for "before the first row of b".
  std::vector<Path> previous(width + 1), current(width + 1);
  previous[0].cost = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    current[0] = Path{};
    for (size_t j = 1; j <= width; ++j) {
      const Path& from = Cheapest(previous[j - 1], previous[j], current[j - 1]);
      const double distance = (a.row(i) - b.row(static_cast<Eigen::Index>(j) - 1)).norm();
      current[j] = {from.cost + distance, from.length + 1};
    }
    std::swap(previous, current);
  }
  return previous[width].cost / previous[width].length;
}

constexpr double kLogTwoPi = 1.8378770664093453;
constexpr int kLeaderComponents = 4, kFollowerComponents = 8;
constexpr int kStates = 3;
constexpr int kIterations = 15;          // of EM
constexpr double kPriorWeight = 50;      // weight of the pooled diagonal covariance, in samples
constexpr double kLeastVariance = 1e-4;  // added to every variance

// Every sequence cut into as many pieces of the same length as there are states.
std::vector<Rows> EvenCut(const std::vector<Rows>& sequences) {
  std::vector<Rows> posteriors;
  for (const Rows& sequence : sequences) {
    Rows posterior = Rows::Zero(sequence.rows(), kStates);
    for (Eigen::Index t = 0; t < sequence.rows(); ++t) {
      posterior(t, t * kStates / sequence.rows()) = 1;
    }
    posteriors.push_back(std::move(posterior));
  }
  return posteriors;
}

// Transition counts of a hard assignment of frames to states.
Eigen::MatrixXd CountJumps(const std::vector<Rows>& posteriors) {
  Eigen::MatrixXd jumps = Eigen::MatrixXd::Zero(kStates, kStates);
  for (const Rows& posterior : posteriors) {
    const Eigen::Index steps = posterior.rows() - 1;
    jumps += posterior.topRows(steps).transpose() * posterior.bottomRows(steps);
  }
  return jumps;
}

Eigen::RowVectorXd PooledVariance(const std::vector<Rows>& sequences) {
  double frames = 0;
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(sequences[0].cols()), squares = sum;
  for (const Rows& sequence : sequences) {
    frames += static_cast<double>(sequence.rows());
    sum += sequence.colwise().sum();
    squares += sequence.cwiseAbs2().colwise().sum();
  }
  return (squares / frames - (sum / frames).cwiseAbs2()).cwiseMax(0);
}

// A hidden Markov model of leader and follower together with Gaussian outputs of full covariance.
// The answer is the expected follower given the whole leader.
//
// Source: Rabiner 1989 (forward-backward, Baum-Welch); regression from a part of the output on the
// rest as in Gaussian mixture regression (Calinon et al. 2010).
class Hmm {
 public:
  // Initialised by cutting every sequence into equal pieces.
  explicit Hmm(const std::vector<StandardPair>& pairs)
      : leader_(Stack(pairs, &StandardPair::cues), kLeaderComponents),
        follower_(Stack(pairs, &StandardPair::follower), kFollowerComponents) {
    std::vector<Rows> sequences;
    for (const StandardPair& pair : pairs) {
      Rows both(pair.cues.rows(), leader_.dimensions() + follower_.dimensions());
      both << leader_.Project(pair.cues), follower_.Project(pair.follower);
      sequences.push_back(std::move(both));
    }
    std::vector<Rows> posteriors = EvenCut(sequences);
    Maximise(sequences, posteriors);
    chain_.step = ConditionalProbabilities(CountJumps(posteriors));
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      Eigen::MatrixXd jumps = Eigen::MatrixXd::Zero(kStates, kStates);
      for (size_t i = 0; i < sequences.size(); ++i) {
        posteriors[i] = SumOverPaths(chain_, LogDensities(sequences[i]), &jumps).states;
      }
      Maximise(sequences, posteriors);
      chain_.step = ConditionalProbabilities(jumps);
    }
  }

  Rows Predict(const StandardPair& leader) const {
    const Rows known = leader_.Project(leader.cues);
    const Rows posterior = SumOverPaths(chain_, LogDensities(known)).states;
    const Eigen::Index n = known.cols(), rest = states_[0].mean.size() - n;
    Rows expected = Rows::Zero(known.rows(), rest);
    for (int k = 0; k < kStates; ++k) {
      const State& state = states_[k];
      // mean_b + S_ba S_aa^-1 (a - mean_a), one row a frame.
      const Eigen::LLT<Eigen::MatrixXd> factor(state.covariance.topLeftCorner(n, n));
      const Eigen::MatrixXd gain = factor.solve(state.covariance.topRightCorner(n, rest));
      const Rows conditional =
          ((known.rowwise() - state.mean.head(n)) * gain).rowwise() + state.mean.tail(rest);
      expected += posterior.col(k).asDiagonal() * conditional;
    }
    return follower_.Reconstruct(expected);
  }

 private:
  struct State {
    Eigen::RowVectorXd mean;
    Eigen::MatrixXd covariance;
  };

  void Maximise(const std::vector<Rows>& sequences, const std::vector<Rows>& posteriors) {
    // A few samples do not determine a full covariance: the pooled diagonal one adds some.
    const Eigen::RowVectorXd prior = PooledVariance(sequences);
    chain_.start = Eigen::RowVectorXd::Constant(kStates, kPseudoCount);
    for (const Rows& posterior : posteriors) chain_.start += posterior.row(0);
    chain_.start /= chain_.start.sum();
    for (int k = 0; k < kStates; ++k) {
      State& state = states_[k];
      double weight = 0;
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(prior.size());
      for (size_t i = 0; i < sequences.size(); ++i) {
        weight += posteriors[i].col(k).sum();
        sum += posteriors[i].col(k).transpose() * sequences[i];
      }
      // A state without frames keeps its parameters.
      if (weight > 0) state.mean = sum / weight;
      if (state.mean.size() == 0) state.mean = sum;
      state.covariance = kPriorWeight * prior.asDiagonal().toDenseMatrix();
      for (size_t i = 0; i < sequences.size(); ++i) {
        const Rows centred = sequences[i].rowwise() - state.mean;
        state.covariance += centred.transpose() * posteriors[i].col(k).asDiagonal() * centred;
      }
      state.covariance /= weight + kPriorWeight;
      state.covariance.diagonal().array() += kLeastVariance;
    }
  }

  // Log densities of rows holding the first values. Shapes: [frames, n] to [frames, states].
  Rows LogDensities(const Rows& known) const {
    const Eigen::Index n = known.cols();
    Rows log_densities(known.rows(), kStates);
    for (int k = 0; k < kStates; ++k) {
      const State& state = states_[k];
      const Eigen::LLT<Eigen::MatrixXd> factor(state.covariance.topLeftCorner(n, n));
      const Eigen::MatrixXd centred = (known.rowwise() - state.mean.head(n)).transpose();
      const Eigen::MatrixXd white = factor.matrixL().solve(centred);
      const double log_root = Eigen::MatrixXd(factor.matrixL()).diagonal().array().log().sum() +
                              0.5 * static_cast<double>(n) * kLogTwoPi;
      log_densities.col(k) = -0.5 * white.colwise().squaredNorm().transpose().array() - log_root;
    }
    return log_densities;
  }

  PoseSpace leader_, follower_;
  State states_[kStates];
  ChainWeights chain_;
};

}  // namespace

std::vector<std::string> BaselineNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kBaselines) names.push_back(entry.name);
  return names;
}

absl::StatusOr<std::vector<metrics::ScoredMotion>> RunBaseline(const std::string& name,
                                                               const dataset::Dataset& dataset,
                                                               const dataset::Split& split) {
  const Entry& entry = *std::find_if(std::begin(kBaselines), std::end(kBaselines),
                                     [&](const Entry& one) { return one.name == name; });
  std::vector<ClassModel> models;
  if (entry.learn != nullptr) {
    DUET_TRY(models, LearnClasses(entry, dataset, split.train));
  }
  std::vector<metrics::ScoredMotion> answers;
  for (const int index : split.test) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    motion::Poses answer(0, dataset.skeleton.joint_count());
    if (entry.learn == nullptr) {
      for (int t = 0; t < sequence.pair.leader.frame_count(); ++t) {
        answer.Append(sequence.pair.follower.poses[0]);
      }
    } else {
      const ClassModel& predict = models[static_cast<size_t>(sequence.interaction_class)];
      const Rows follower = predict(StandardLeader(dataset.skeleton, sequence));
      answer =
          metrics::StandardOf(dataset.skeleton, sequence, kEveryFrame).Invert(FromRows(follower));
    }
    const auto all = answer.all();
    if (!std::all_of(all.begin(), all.end(), [](motion::Vec3 p) { return IsFinite(p); })) {
      return absl::InternalError(absl::StrCat(name, ": ", sequence.id,
                                              ": expected finite positions, got one that is not"));
    }
    answers.push_back({index, std::move(answer)});
  }
  return answers;
}

absl::StatusOr<std::vector<metrics::ScoredMotion>> AnswerWithOtherPeople(
    const dataset::Dataset& dataset, const dataset::Split& split, uint64_t seed) {
  base::Random random(seed);
  std::vector<metrics::ScoredMotion> answers;
  for (const int index : split.test) {
    const dataset::Sequence& asked = dataset.sequences[static_cast<size_t>(index)];
    const int frames = asked.pair.leader.frame_count();
    const auto candidates = Candidates(dataset, split.train, asked.interaction_class, frames);
    if (candidates.empty()) {
      return absl::InvalidArgumentError(absl::StrCat(
          "other people: expected at least one training sequence of class ",
          dataset.classes[static_cast<size_t>(asked.interaction_class)], ", got none"));
    }
    const auto drawn = random.Below(static_cast<int64_t>(candidates.size()));
    const dataset::Sequence& other = *candidates[static_cast<size_t>(drawn)];
    const Rows motion = ToRows(
        metrics::StandardOf(dataset.skeleton, other, kFirstFrame).Apply(other.pair.follower.poses));
    const Rows fitted =
        motion.rows() < frames ? StretchTo(motion, frames) : Rows(motion.topRows(frames));
    answers.push_back(
        {index,
         metrics::StandardOf(dataset.skeleton, asked, kFirstFrame).Invert(FromRows(fitted))});
  }
  return answers;
}

Rows ToRows(const motion::Poses& poses) {
  return Eigen::Map<const FloatRows>(&poses.all().front().x, poses.frame_count(),
                                     3 * poses.joint_count())
      .cast<double>();
}

motion::Poses FromRows(const Rows& rows) {
  motion::Poses poses(static_cast<int>(rows.rows()), static_cast<int>(rows.cols() / 3));
  Eigen::Map<FloatRows>(&poses.all().front().x, rows.rows(), rows.cols()) = rows.cast<float>();
  return poses;
}

Eigen::MatrixXd ConditionalProbabilities(const Eigen::MatrixXd& counts) {
  const Eigen::MatrixXd padded = counts.array() + kPseudoCount;
  return padded.array().colwise() / padded.rowwise().sum().array();
}

StandardPair StandardLeader(const motion::Skeleton& skeleton, const dataset::Sequence& sequence) {
  const motion::Standardisation frame = metrics::StandardOf(skeleton, sequence, kEveryFrame);
  const motion::Poses& leader = sequence.pair.leader.poses;
  return {ToRows(frame.Apply(leader)), LeaderCues(frame, leader), {}};
}

StandardPair StandardiseSequence(const motion::Skeleton& skeleton,
                                 const dataset::Sequence& sequence) {
  StandardPair pair = StandardLeader(skeleton, sequence);
  const motion::Poses& follower = sequence.pair.follower.poses;
  pair.follower = ToRows(metrics::StandardOf(skeleton, sequence, kEveryFrame).Apply(follower));
  return pair;
}

Rows StretchTo(const Rows& motion, Eigen::Index frames) {
  Rows out(frames, motion.cols());
  const double last = static_cast<double>(motion.rows() - 1);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const double at =
        frames == 1 ? 0 : static_cast<double>(t) * last / static_cast<double>(frames - 1);
    const Eigen::Index whole = std::min(static_cast<Eigen::Index>(at), motion.rows() - 1);
    const Eigen::Index next = std::min(whole + 1, motion.rows() - 1);
    out.row(t) = motion.row(whole) +
                 (at - static_cast<double>(whole)) * (motion.row(next) - motion.row(whole));
  }
  return out;
}

Eigen::MatrixXd SquaredDistances(const Rows& a, const Rows& b) {
  Eigen::MatrixXd distances = -2 * a * b.transpose();
  distances.colwise() += a.rowwise().squaredNorm();
  distances.rowwise() += b.rowwise().squaredNorm().transpose();
  return distances.cwiseMax(0);
}

PoseSpace::PoseSpace(const Rows& rows, Eigen::Index dimensions) : mean_(rows.colwise().mean()) {
  const Rows centred = rows.rowwise() - mean_;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(centred.transpose() * centred);
  const Eigen::VectorXd& variance = solver.eigenvalues();  // ascending
  const Eigen::Index values = rows.cols();
  const double least = kNoVariance * std::max(variance(values - 1), 0.0);
  Eigen::Index kept = std::min(dimensions, values);
  while (kept > 1 && variance(values - kept) <= least) --kept;
  basis_ = solver.eigenvectors().rightCols(kept).rowwise().reverse();
}

Rows PoseSpace::Project(const Rows& rows) const { return (rows.rowwise() - mean_) * basis_; }

Rows PoseSpace::Reconstruct(const Rows& components) const {
  return (components * basis_.transpose()).rowwise() + mean_;
}

Rows StackRows(const std::vector<Rows>& parts) {
  Eigen::Index rows = 0;
  for (const Rows& part : parts) rows += part.rows();
  Rows stacked(rows, parts.front().cols());
  rows = 0;
  for (const Rows& part : parts) {
    stacked.middleRows(rows, part.rows()) = part;
    rows += part.rows();
  }
  return stacked;
}

Rows Stack(const std::vector<StandardPair>& pairs, Rows StandardPair::*part) {
  std::vector<Rows> parts;
  for (const StandardPair& pair : pairs) parts.push_back(pair.*part);
  return StackRows(parts);
}

std::vector<int> NearestCentres(const Rows& centres, const Rows& rows) {
  std::vector<int> nearest;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    Eigen::Index of_row = 0;
    (centres.rowwise() - rows.row(i)).rowwise().squaredNorm().minCoeff(&of_row);
    nearest.push_back(static_cast<int>(of_row));
  }
  return nearest;
}

Rows KMeans(const Rows& rows, int clusters, uint64_t seed) {
  base::Random random(seed);
  Rows centres = Seeds(rows, clusters, &random);
  std::vector<int> members;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    std::vector<int> nearest = NearestCentres(centres, rows);
    if (nearest == members) break;
    members = std::move(nearest);
    Rows sums = Rows::Zero(centres.rows(), centres.cols());
    Eigen::VectorXd counts = Eigen::VectorXd::Zero(centres.rows());
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const int centre = members[static_cast<size_t>(i)];
      sums.row(centre) += rows.row(i);
      counts(centre) += 1;
    }
    // A centre that lost all its rows stays where it was.
    for (Eigen::Index c = 0; c < centres.rows(); ++c) {
      if (counts(c) > 0) centres.row(c) = sums.row(c) / counts(c);
    }
  }
  return centres;
}

PathPosterior SumOverPaths(const ChainWeights& chain, const Rows& log_arrivals,
                           Eigen::MatrixXd* steps) {
  const Eigen::Index frames = log_arrivals.rows(), states = log_arrivals.cols();
  // Relative to each frame's largest, and messages that sum to one: no underflow.
  const Eigen::VectorXd largest = log_arrivals.rowwise().maxCoeff();
  const Rows arrivals = (log_arrivals.colwise() - largest).array().exp();
  Rows forward(frames, states), backward(frames, states);
  PathPosterior posterior;
  posterior.log_sum = largest.sum();
  forward.row(0) = chain.start;
  for (Eigen::Index t = 0; t < frames; ++t) {
    if (t > 0) forward.row(t).noalias() = forward.row(t - 1) * chain.step;
    forward.row(t).array() *= arrivals.row(t).array();
    const double scale = forward.row(t).sum();
    forward.row(t) /= scale;
    posterior.log_sum += std::log(scale);
  }
  backward.row(frames - 1).setOnes();
  for (Eigen::Index t = frames - 2; t >= 0; --t) {
    const Eigen::VectorXd leaving =
        arrivals.row(t + 1).cwiseProduct(backward.row(t + 1)).transpose();
    backward.row(t) = (chain.step * leaving).transpose();
    backward.row(t) /= backward.row(t).sum();
    if (steps == nullptr) continue;
    const Eigen::MatrixXd joint =
        chain.step.cwiseProduct(forward.row(t).transpose() * leaving.transpose());
    *steps += joint / joint.sum();
  }
  posterior.states = forward.cwiseProduct(backward);
  posterior.states.array().colwise() /= posterior.states.rowwise().sum().array().eval();
  return posterior;
}

ClassModel LearnClassMean(const std::vector<StandardPair>& pairs) {
  // Each frame has the same weight, as in the metric.
  const Eigen::RowVectorXd mean = Stack(pairs, &StandardPair::follower).colwise().mean();
  return [mean](const StandardPair& leader) -> Rows {
    return mean.replicate(leader.leader.rows(), 1);
  };
}

ClassModel LearnNearestNeighbour(const std::vector<StandardPair>& pairs) {
  return [pairs](const StandardPair& leader) {
    std::vector<double> distances;
    for (const StandardPair& pair : pairs) {
      distances.push_back(TimeWarpedDistance(leader.leader, pair.leader));
    }
    const auto nearest = std::min_element(distances.begin(), distances.end()) - distances.begin();
    return StretchTo(pairs[static_cast<size_t>(nearest)].follower, leader.leader.rows());
  };
}

ClassModel LearnHmm(const std::vector<StandardPair>& pairs) {
  return [model = Hmm(pairs)](const StandardPair& leader) { return model.Predict(leader); };
}

}  // namespace duet::evaluation::baselines
