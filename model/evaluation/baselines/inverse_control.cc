// The baselines that infer a reward from demonstrations, and plan with it.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "model/base/median.h"
#include "model/base/random.h"
#include "model/evaluation/baselines/baselines.h"

namespace duet::evaluation::baselines {
namespace {

constexpr int kComponents = 10;     // principal components of cues and, unless stated, poses
constexpr int kDemonstrations = 8;  // clips from which a reward is learnt at a time
constexpr uint64_t kSeed = 1;

// KZBH12: a discrete Markov decision process.

constexpr int kPoseStates = 16;   // clusters of follower poses
constexpr int kLeaderStates = 8;  // clusters of leader cues
constexpr int kAscents = 30;      // gradient steps on the reward
// Gradient ascent on the mean log-likelihood of a frame: rate, and pull towards the initial
// weights.
constexpr double kAscentRate = 0.3;
constexpr double kPull = 0.01;

// Weights of the features of arriving at a pose: how well it matches the leader's cluster, how
// frequent the step is, how little the pose changes.
using MdpWeights = Eigen::Vector3d;

// A training sequence as cluster indices.
struct Labelled {
  std::vector<int> leader;
  std::vector<int> pose;
};

// How often clusters occur together.
struct Counts {
  Counts(Eigen::Index poses, Eigen::Index leaders)
      : together(Eigen::MatrixXd::Zero(poses, leaders)),
        steps(Eigen::MatrixXd::Zero(poses, poses)),
        starts(Eigen::MatrixXd::Zero(1, poses)) {}

  void Add(const Labelled& one, double times) {
    starts(0, one.pose[0]) += times;
    for (size_t t = 0; t < one.pose.size(); ++t) {
      together(one.pose[t], one.leader[t]) += times;
      if (t > 0) steps(one.pose[t - 1], one.pose[t]) += times;
    }
  }

  Eigen::MatrixXd together;  // [pose, leader]
  Eigen::MatrixXd steps;     // [from, to]
  Eigen::MatrixXd starts;    // [1, pose]
};

// The features that follow from counts, as logs of smoothed conditional probabilities.
struct Tables {
  Tables() = default;
  explicit Tables(const Counts& counts)
      : leader_given_pose(ConditionalProbabilities(counts.together).array().log().transpose()),
        step(ConditionalProbabilities(counts.steps).array().log()),
        start(ConditionalProbabilities(counts.starts).array().log()) {}

  Rows leader_given_pose;    // [leader, pose]
  Eigen::MatrixXd step;      // [from, to]
  Eigen::RowVectorXd start;  // [pose]
};

class DiscreteMdp {
 public:
  explicit DiscreteMdp(const std::vector<StandardPair>& pairs) {
    const Rows cues = Stack(pairs, &StandardPair::cues),
               poses = Stack(pairs, &StandardPair::follower);
    leader_ = PoseSpace(cues, kComponents);
    follower_ = PoseSpace(poses, kComponents);
    leader_centres_ = KMeans(leader_.Project(cues), kLeaderStates, kSeed);
    pose_centres_ = KMeans(follower_.Project(poses), kPoseStates, kSeed);
    effort_.resize(pose_centres_.rows(), pose_centres_.rows());
    for (Eigen::Index from = 0; from < effort_.rows(); ++from) {
      effort_.row(from) =
          -(pose_centres_.rowwise() - pose_centres_.row(from)).rowwise().squaredNorm();
    }
    std::vector<Labelled> demonstrations;
    Counts counts(pose_centres_.rows(), leader_centres_.rows());
    for (const StandardPair& pair : pairs) {
      demonstrations.push_back({NearestCentres(leader_centres_, leader_.Project(pair.cues)),
                                NearestCentres(pose_centres_, follower_.Project(pair.follower))});
      counts.Add(demonstrations.back(), 1);
    }
    tables_ = Tables(counts);
    LearnReward(demonstrations, counts);
  }

  Rows Predict(const StandardPair& leader) const {
    const std::vector<int> seen = NearestCentres(leader_centres_, leader_.Project(leader.cues));
    return follower_.Reconstruct(Visits(tables_, seen) * pose_centres_);
  }

 private:
  void LearnReward(const std::vector<Labelled>& demonstrations, const Counts& counts) {
    // Each demonstration is explained by the counts of the others: its own would overfit.
    std::vector<Tables> others;
    double frames = 0;
    for (const Labelled& one : demonstrations) {
      Counts rest = counts;
      if (demonstrations.size() > 1) rest.Add(one, -1);
      others.emplace_back(rest);
      frames += static_cast<double>(one.pose.size());
    }
    const MdpWeights initial = MdpWeights(1, 1, 0);
    weights_ = initial;
    MdpWeights squares = MdpWeights::Constant(1e-12);
    for (int iteration = 0; iteration < kAscents; ++iteration) {
      MdpWeights gradient = MdpWeights::Zero();
      for (size_t i = 0; i < demonstrations.size(); ++i) {
        gradient += Surplus(others[i], demonstrations[i]);
      }
      gradient = gradient / frames - kPull * (weights_ - initial);
      squares += gradient.cwiseAbs2();
      weights_ += kAscentRate * gradient.cwiseQuotient(squares.cwiseSqrt());
    }
  }

  // Features of the demonstration minus the policy's expected features.
  MdpWeights Surplus(const Tables& tables, const Labelled& one) const {
    Eigen::MatrixXd steps = Eigen::MatrixXd::Zero(effort_.rows(), effort_.cols());
    const Rows visits = Visits(tables, one.leader, &steps);
    MdpWeights surplus(0, tables.start(one.pose[0]) - visits.row(0).dot(tables.start), 0);
    for (size_t t = 0; t < one.pose.size(); ++t) {
      const auto fit = tables.leader_given_pose.row(one.leader[t]);
      surplus(0) += fit(one.pose[t]) - visits.row(static_cast<Eigen::Index>(t)).dot(fit);
      if (t > 0) steps(one.pose[t - 1], one.pose[t]) -= 1;
    }
    surplus(1) -= steps.cwiseProduct(tables.step).sum();
    surplus(2) -= steps.cwiseProduct(effort_).sum();
    return surplus;
  }

  // How probable each pose is in each frame. `steps`: as in SumOverPaths.
  Rows Visits(const Tables& tables, const std::vector<int>& leader,
              Eigen::MatrixXd* steps = nullptr) const {
    const Rows arrivals = weights_(0) * tables.leader_given_pose(leader, Eigen::all);
    const ChainWeights chain = {(weights_(1) * tables.start).array().exp(),
                                (weights_(1) * tables.step + weights_(2) * effort_).array().exp()};
    return SumOverPaths(chain, arrivals, steps).states;
  }

  PoseSpace leader_, follower_;
  Rows leader_centres_, pose_centres_;  // in the components
  Tables tables_;
  Eigen::MatrixXd effort_;  // [from, to] minus the squared change of pose
  MdpWeights weights_;
};

// HK14: kernel-based reinforcement learning.

// The most training frames to keep: of more, every second (third, ...) one, and the leader's
// likewise.
constexpr int kMostSamples = 400;
// Widths of the kernels, in units of the median distance to the nearest sample of another clip.
constexpr double kTransitionWidth = 1, kDecodingWidth = 4;
constexpr double kVelocityWeight = 2;  // weight of the change over a step, relative to the pose
constexpr double kNever = -1e9;        // log weight of an excluded sample
// Minimum width of a kernel, relative to the root mean squared distance: otherwise repeated takes
// of one motion would make every other motion infinitely far.
constexpr double kLeastWidth = 0.05;
constexpr double kTiny = 1e-9;
// Candidate weights of the reward: powers of two times that of a Gaussian of the cues' own width.
constexpr int kLeastPower = -8, kMostPower = 4;
constexpr int kMeanShifts = 20;

// The median over samples of the distance to the nearest one of another clip.
double MedianNearest(const Eigen::MatrixXd& squared, const std::vector<int>& clip) {
  std::vector<double> nearest;
  for (Eigen::Index i = 0; i < squared.rows(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index j = 0; j < squared.cols(); ++j) {
      const bool other = clip[static_cast<size_t>(i)] != clip[static_cast<size_t>(j)];
      if (other) least = std::min(least, squared(i, j));
    }
    if (std::isfinite(least)) nearest.push_back(std::sqrt(least));
  }
  const double least_width = kLeastWidth * std::sqrt(squared.mean()) + kTiny;
  if (nearest.empty()) return least_width;  // a single clip
  return std::max(base::Median(nearest), least_width);
}

// Rows 0, n, 2 n, ...
Rows EveryNth(const Rows& rows, Eigen::Index n) {
  return rows(Eigen::seq(0, rows.rows() - 1, n), Eigen::all);
}

// Inverts EveryNth: linear between the kept rows, constant after the last.
Rows FillBetween(const Rows& kept, Eigen::Index n, Eigen::Index rows) {
  Rows filled(rows, kept.cols());
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Eigen::Index next = std::min(i / n + 1, kept.rows() - 1);
    const double part = static_cast<double>(i % n) / static_cast<double>(n);
    filled.row(i) = (1 - part) * kept.row(i / n) + part * kept.row(next);
  }
  return filled;
}

class KernelRl {
 public:
  explicit KernelRl(const std::vector<StandardPair>& pairs) {
    const Rows cues = Stack(pairs, &StandardPair::cues),
               poses = Stack(pairs, &StandardPair::follower);
    leader_ = PoseSpace(cues, kComponents);
    follower_ = PoseSpace(poses, kComponents);
    stride_ = (cues.rows() + kMostSamples - 1) / kMostSamples;
    std::vector<Eigen::Index> kept;
    std::vector<int> successor;
    Eigen::Index first = 0;
    for (size_t i = 0; i < pairs.size(); ++i) {
      const Eigen::Index frames = pairs[i].cues.rows();
      for (Eigen::Index t = 0; t < frames; t += stride_) {
        const int index = static_cast<int>(kept.size());
        kept.push_back(first + t);
        clip_.push_back(static_cast<int>(i));
        // A clip's last pose follows itself.
        successor.push_back(t + stride_ < frames ? index + 1 : index);
      }
      first += frames;
    }
    cues_ = leader_.Project(cues(kept, Eigen::all));
    poses_ = follower_.Project(poses(kept, Eigen::all));
    BuildStep(successor);
    LearnReward(pairs);
  }

  Rows Predict(const StandardPair& leader) const {
    const Rows visits = Plan(reward_weight_ * Cost(leader.cues), /*without=*/-1).states;
    return follower_.Reconstruct(FillBetween(MeanShift(visits), stride_, leader.cues.rows()));
  }

 private:
  void BuildStep(const std::vector<int>& successor) {
    // A state is a pose and its change: without the change, motion could reverse freely.
    const Eigen::Index samples = poses_.rows(), width = poses_.cols();
    Rows states(samples, 2 * width);
    for (Eigen::Index i = 0; i < samples; ++i) {
      const Eigen::Index next = successor[static_cast<size_t>(i)];
      states.row(i) << poses_.row(i), kVelocityWeight * (poses_.row(next) - poses_.row(i));
    }
    pose_width_ = MedianNearest(SquaredDistances(poses_, poses_), clip_);
    const Eigen::MatrixXd squared = SquaredDistances(states, states);
    const double spread = kTransitionWidth * MedianNearest(squared, clip_);
    Eigen::MatrixXd kernel = (-squared / (2 * spread * spread)).array().exp();
    kernel.array().colwise() /= kernel.rowwise().sum().array().eval();
    step_ = Eigen::MatrixXd::Zero(samples, samples);
    for (Eigen::Index like = 0; like < samples; ++like) {
      step_.col(successor[static_cast<size_t>(like)]) += kernel.col(like);
    }
  }

  void LearnReward(const std::vector<StandardPair>& pairs) {
    const double cue_width = MedianNearest(SquaredDistances(cues_, cues_), clip_);
    double best = -std::numeric_limits<double>::infinity();
    for (int power = kLeastPower; power <= kMostPower; ++power) {
      const double weight = std::pow(2, power) / (2 * cue_width * cue_width);
      const double likelihood = LogLikelihood(pairs, weight);
      if (likelihood <= best) continue;
      best = likelihood;
      reward_weight_ = weight;
    }
  }

  double LogLikelihood(const std::vector<StandardPair>& pairs, double weight) const {
    const size_t stride = std::max<size_t>(1, pairs.size() / size_t{kDemonstrations});
    const double precision = 1 / (2 * pose_width_ * pose_width_);
    double sum = 0;
    for (size_t i = 0; pairs.size() > 1 && i < pairs.size(); i += stride) {
      const int clip = static_cast<int>(i);
      const Rows cost = weight * Cost(pairs[i].cues);
      const Rows noise =
          precision *
          SquaredDistances(EveryNth(follower_.Project(pairs[i].follower), stride_), poses_);
      sum += Plan(cost + noise, clip).log_sum - Plan(cost, clip).log_sum;
    }
    return sum;
  }

  // Distances between the leader's cues and each sample's. Shapes: returns [frames / stride,
  // samples].
  Rows Cost(const Rows& cues) const {
    return SquaredDistances(EveryNth(leader_.Project(cues), stride_), cues_);
  }

  // Soft value iteration and the policy's visits, given the cost of arriving at each sample in each
  // frame. Ignores samples of the clip `without` (-1: none).
  PathPosterior Plan(const Rows& cost, int without) const {
    Rows arrivals = -cost;
    for (Eigen::Index i = 0; i < arrivals.cols(); ++i) {
      if (clip_[static_cast<size_t>(i)] == without) arrivals.col(i).setConstant(kNever);
    }
    return SumOverPaths({Eigen::RowVectorXd::Ones(arrivals.cols()), step_}, arrivals);
  }

  Rows MeanShift(const Rows& visits) const {
    const double width = kDecodingWidth * pose_width_;
    Rows poses(visits.rows(), poses_.cols());
    for (Eigen::Index t = 0; t < visits.rows(); ++t) {
      Eigen::Index likeliest = 0;
      visits.row(t).maxCoeff(&likeliest);
      Rows pose = poses_.row(likeliest);
      for (int i = 0; i < kMeanShifts; ++i) {
        const Eigen::RowVectorXd kernel =
            (-SquaredDistances(pose, poses_) / (2 * width * width)).array().exp();
        const Eigen::RowVectorXd weights = kernel.cwiseProduct(visits.row(t));
        pose = weights * poses_ / weights.sum();
      }
      poses.row(t) = pose;
    }
    return poses;
  }

  PoseSpace leader_, follower_;
  Eigen::Index stride_ = 1;  // frames from one sample to the next
  Rows cues_, poses_;        // [samples, components]
  std::vector<int> clip_;    // the sequence of each sample
  Eigen::MatrixXd step_;     // [from, to]: transitions from samples similar to `from`
  double pose_width_ = 1;    // median distance to the nearest sample of another clip
  double reward_weight_ = 1;
};

// HFKB15: approximate maximum-entropy inverse optimal control.

constexpr int kPoseComponents = 8;
constexpr double kRidge = 0.2;        // of the regression from the leader's cues to expected poses
constexpr int kActions = 24;          // candidate displacements: clusters of those in training
constexpr int kValueSamples = 150;    // poses on which the value function is fitted
constexpr int kValueCentres = 32;     // radial functions of the value function
constexpr int kIterations = 15;       // exponentiated gradient steps
constexpr int kRollouts = 16;         // sampled paths for an expectation
constexpr int kAnswerRollouts = 200;  // paths whose mean is the answer
constexpr double kValueRidge = 1e-3;
constexpr double kRate = 0.5;  // rate of the exponentiated gradient
constexpr double kLeastWeight = 1e-3, kMostWeight = 1e4;
constexpr double kLeastFeature = 1e-9;

Rows WithConstant(const Rows& rows) {
  Rows out(rows.rows(), rows.cols() + 1);
  out << rows, Eigen::VectorXd::Ones(rows.rows());
  return out;
}

// The mean distance of a centre to the nearest other one.
double MeanSpacing(const Rows& centres) {
  if (centres.rows() < 2) return 1;
  Eigen::MatrixXd squared = SquaredDistances(centres, centres);
  squared.diagonal().setConstant(squared.maxCoeff());
  return std::max(squared.rowwise().minCoeff().cwiseSqrt().mean(), 1e-6);
}

// At most `count` rows, evenly spaced.
Rows Thin(const Rows& rows, Eigen::Index count) {
  if (rows.rows() <= count) return rows;
  Rows kept(count, rows.cols());
  for (Eigen::Index i = 0; i < count; ++i) kept.row(i) = rows.row(i * rows.rows() / count);
  return kept;
}

// Ridge regression to poses from cues and a constant, which is not regularised. `ridge` is relative
// to the cues' mean square.
Eigen::MatrixXd FitRegression(const Rows& cues, const Rows& poses, double ridge) {
  const Rows inputs = WithConstant(cues);
  Eigen::MatrixXd normal = inputs.transpose() * inputs;
  normal.diagonal().head(cues.cols()).array() += ridge * normal.diagonal().head(cues.cols()).mean();
  return normal.ldlt().solve(inputs.transpose() * poses);
}

// All rows but `count` from `first` on.
Rows Without(const Rows& rows, Eigen::Index first, Eigen::Index count) {
  Rows rest(rows.rows() - count, rows.cols());
  rest << rows.topRows(first), rows.bottomRows(rows.rows() - first - count);
  return rest;
}

// The change from each pose of a clip to the next. Shapes: [frames, n] to [frames - 1, n].
Rows Changes(const Rows& poses) {
  return poses.bottomRows(poses.rows() - 1) - poses.topRows(poses.rows() - 1);
}

// Every row of `b` added to every row of `a`: all of row 0 of `a` first.
Rows OuterSum(const Rows& a, const Rows& b) {
  Rows sums(a.rows() * b.rows(), a.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    sums.middleRows(i * b.rows(), b.rows()) = b.rowwise() + a.row(i);
  }
  return sums;
}

// Costs of a step under the leader's cues, all squared lengths: from the next pose to the one
// expected from the cues, to the previous pose, and to the mean pose of the class.
constexpr int kFeatures = 3;
using Weights = Eigen::Matrix<double, kFeatures, 1>;
using Costs = Eigen::Matrix<double, Eigen::Dynamic, kFeatures>;

// A training clip, with the poses that a regression fitted without it expects.
struct Demonstration {
  Rows expected;
  Rows poses;
  Weights costs;  // of all its steps
};

Demonstration Demonstrate(Rows expected, Rows poses) {
  Demonstration one = {std::move(expected), std::move(poses), Weights::Zero()};
  const Eigen::Index steps = one.poses.rows() - 1;
  one.costs(0) = (one.poses - one.expected).bottomRows(steps).squaredNorm();
  one.costs(1) = Changes(one.poses).squaredNorm();
  one.costs(2) = one.poses.bottomRows(steps).squaredNorm();
  return one;
}

// Sampled answers to one leader.
struct Rollouts {
  Rows mean;                        // [frames, components]
  Weights costs = Weights::Zero();  // of all steps, the mean over paths
};

class MaxEntIoc {
 public:
  explicit MaxEntIoc(const std::vector<StandardPair>& pairs) {
    const Rows all_cues = Stack(pairs, &StandardPair::cues),
               all_poses = Stack(pairs, &StandardPair::follower);
    leader_ = PoseSpace(all_cues, kComponents);
    follower_ = PoseSpace(all_poses, kPoseComponents);
    const Rows cues = leader_.Project(all_cues), poses = follower_.Project(all_poses);
    regression_ = FitRegression(cues, poses, kRidge);
    std::vector<Rows> changes;
    Eigen::Index first = 0;
    for (const StandardPair& pair : pairs) {
      changes.push_back(Changes(poses.middleRows(first, pair.cues.rows())));
      first += pair.cues.rows();
    }
    PrepareActions(StackRows(changes));
    PrepareValues(poses);
    std::vector<Demonstration> demonstrations;
    first = 0;
    for (const StandardPair& pair : pairs) {
      const Eigen::Index frames = pair.cues.rows();
      // Fitted without the clip, which the regression would otherwise memorise.
      const Eigen::MatrixXd regression =
          pairs.size() == 1
              ? regression_
              : FitRegression(Without(cues, first, frames), Without(poses, first, frames), kRidge);
      demonstrations.push_back(
          Demonstrate(WithConstant(cues.middleRows(first, frames)) * regression,
                      poses.middleRows(first, frames)));
      first += frames;
    }
    LearnReward(demonstrations);
  }

  Rows Predict(const StandardPair& leader) const {
    const Rows expected = WithConstant(leader_.Project(leader.cues)) * regression_;
    base::Random random(kSeed);
    return follower_.Reconstruct(Sample(expected, kAnswerRollouts, &random).mean);
  }

 private:
  // The radial functions at the centres, normalised to a sum of one. Shapes: squared [n, centres].
  Rows Basis(const Eigen::MatrixXd& squared) const {
    // Relative to the nearest centre, so that the sum never underflows. Normalisation bounds the
    // values of poses far from all centres by those near them.
    const Eigen::VectorXd nearest = squared.rowwise().minCoeff();
    Rows basis = (-(squared.colwise() - nearest) / (2 * width_ * width_)).array().exp();
    basis.array().colwise() /= basis.rowwise().sum().array().eval();
    return basis;
  }

  void PrepareActions(const Rows& changes) {
    actions_ = KMeans(changes, kActions, kSeed);
    Eigen::VectorXd counts = Eigen::VectorXd::Ones(actions_.rows());
    for (const int action : NearestCentres(actions_, changes)) counts(action) += 1;
    usual_ = (counts / counts.sum()).array().log();
  }

  void PrepareValues(const Rows& poses) {
    centres_ = KMeans(poses, kValueCentres, kSeed);
    width_ = MeanSpacing(centres_);
    samples_ = Thin(poses, kValueSamples);
    arrivals_ = OuterSum(samples_, actions_);
    const Eigen::MatrixXd squared = SquaredDistances(arrivals_, centres_);
    arrival_basis_ = Basis(squared);
    arrival_costs_ = Costs::Zero(squared.rows(), kFeatures);
    arrival_costs_.col(1) = actions_.rowwise().squaredNorm().replicate(samples_.rows(), 1);
    arrival_costs_.col(2) = arrivals_.rowwise().squaredNorm();
    const Rows basis = Basis(SquaredDistances(samples_, centres_));
    Eigen::MatrixXd normal = basis.transpose() * basis;
    normal.diagonal().array() += kValueRidge;
    fit_ = normal.ldlt().solve(Eigen::MatrixXd(basis.transpose()));
  }

  // Coefficients of the soft value function of each frame. Shapes: returns [frames, basis].
  Rows SoftValues(const Rows& expected) const {
    const Eigen::Index actions = actions_.rows(), samples = samples_.rows();
    const Eigen::VectorXd fixed = arrival_costs_ * weights_;
    Rows values = Rows::Zero(expected.rows(), arrival_basis_.cols());
    for (Eigen::Index t = expected.rows() - 2; t >= 0; --t) {
      // V_t(s) = log sum_a p(a) exp(r(s, s + a) + V_{t+1}(s + a)), fitted on the samples.
      const Eigen::VectorXd totals =
          arrival_basis_ * values.row(t + 1).transpose() - fixed -
          weights_(0) * (arrivals_.rowwise() - expected.row(t + 1)).rowwise().squaredNorm();
      Eigen::VectorXd targets(samples);
      for (Eigen::Index i = 0; i < samples; ++i) {
        const Eigen::VectorXd choices = totals.segment(i * actions, actions) + usual_;
        const double largest = choices.maxCoeff();
        targets(i) = largest + std::log((choices.array() - largest).exp().sum());
      }
      values.row(t) = (fit_ * targets).transpose();
    }
    return values;
  }

  // Samples `paths` answers from the policy of the soft value function.
  Rollouts Sample(const Rows& expected, int paths, base::Random* random) const {
    const Rows values = SoftValues(expected);
    const Eigen::Index actions = actions_.rows();
    const Eigen::VectorXd effort = actions_.rowwise().squaredNorm();
    Rollouts rollouts;
    rollouts.mean.resize(expected.rows(), expected.cols());
    rollouts.mean.row(0) = expected.row(0);
    Rows poses = expected.row(0).replicate(paths, 1);
    for (Eigen::Index t = 1; t < expected.rows(); ++t) {
      const Rows next = OuterSum(poses, actions_);
      Costs costs(next.rows(), kFeatures);
      costs.col(0) = (next.rowwise() - expected.row(t)).rowwise().squaredNorm();
      costs.col(1) = effort.replicate(paths, 1);
      costs.col(2) = next.rowwise().squaredNorm();
      const Eigen::VectorXd totals =
          Basis(SquaredDistances(next, centres_)) * values.row(t).transpose() - costs * weights_;
      for (int path = 0; path < paths; ++path) {
        const Eigen::VectorXd choices = totals.segment(path * actions, actions) + usual_;
        const Eigen::VectorXd policy = (choices.array() - choices.maxCoeff()).exp();
        const Eigen::Index pick = path * actions + SampleIndex(policy, random);
        poses.row(path) = next.row(pick);
        rollouts.costs += costs.row(pick).transpose() / paths;
      }
      rollouts.mean.row(t) = poses.colwise().mean();
    }
    return rollouts;
  }

  void LearnReward(const std::vector<Demonstration>& demonstrations) {
    base::Random random(kSeed);
    // Initial weights: those of independent Gaussians with the demonstrations' spread.
    Weights total = Weights::Constant(kLeastFeature);
    double steps = 0;
    for (const Demonstration& one : demonstrations) {
      total += one.costs;
      steps += static_cast<double>(one.poses.rows() - 1);
    }
    const double freedom = steps * static_cast<double>(samples_.cols());
    weights_ = 0.5 * freedom * total.cwiseInverse();
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      Weights excess = Weights::Zero(), scale = Weights::Constant(kLeastFeature);
      for (int i = 0; i < kDemonstrations; ++i) {
        const auto drawn = random.Below(static_cast<int64_t>(demonstrations.size()));
        const Demonstration& one = demonstrations[static_cast<size_t>(drawn)];
        excess += Sample(one.expected, kRollouts, &random).costs - one.costs;
        scale += one.costs;
      }
      // Raise the weight of costs that the policy incurs more than people do.
      const Weights step = excess.cwiseQuotient(scale).cwiseMax(-1).cwiseMin(1);
      const double rate = kRate / std::sqrt(1.0 + iteration);
      weights_ = weights_.cwiseProduct((rate * step).array().exp().matrix())
                     .cwiseMax(kLeastWeight)
                     .cwiseMin(kMostWeight);
    }
  }

  PoseSpace leader_, follower_;
  Eigen::MatrixXd regression_;  // from cues and a constant to poses
  Rows centres_;                // clusters of training poses
  double width_ = 1;            // of the radial functions at the centres
  Rows actions_;                // candidate displacements
  Eigen::VectorXd usual_;       // [actions] log of the frequency in training
  Rows samples_;                // poses on which the value function is fitted
  Rows arrivals_;               // [samples x actions] the pose after each action from each sample
  Rows arrival_basis_;          // their value basis
  Costs arrival_costs_;         // their costs, except the first, which depends on the leader
  Eigen::MatrixXd fit_;         // [basis, samples]: values at the samples to coefficients
  Weights weights_;
};

}  // namespace

ClassModel LearnDiscreteMdp(const std::vector<StandardPair>& pairs) {
  return [model = DiscreteMdp(pairs)](const StandardPair& leader) { return model.Predict(leader); };
}

ClassModel LearnKernelRl(const std::vector<StandardPair>& pairs) {
  return [model = KernelRl(pairs)](const StandardPair& leader) { return model.Predict(leader); };
}

ClassModel LearnMaxEntIoc(const std::vector<StandardPair>& pairs) {
  return [model = MaxEntIoc(pairs)](const StandardPair& leader) { return model.Predict(leader); };
}

}  // namespace duet::evaluation::baselines
