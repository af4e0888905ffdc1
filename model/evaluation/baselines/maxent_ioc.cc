#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "model/base/random.h"
#include "model/evaluation/baselines/class_models.h"

namespace duet::evaluation::baselines {
namespace {

constexpr int kLeaderComponents = 10, kPoseComponents = 8;
constexpr double kRidge = 0.2;        // of the regression from the leader's cues to expected poses
constexpr int kActions = 24;          // candidate displacements: clusters of those in training
constexpr int kValueSamples = 150;    // poses on which the value function is fitted
constexpr int kValueCentres = 32;     // radial functions of the value function
constexpr int kIterations = 15;       // exponentiated gradient steps
constexpr int kDemonstrations = 8;    // clips in each iteration
constexpr int kRollouts = 16;         // sampled paths for an expectation
constexpr int kAnswerRollouts = 200;  // paths whose mean is the answer
constexpr uint64_t kSeed = 1;
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

class MaxEntIoc : public ClassModel {
 public:
  explicit MaxEntIoc(const std::vector<StandardPair>& pairs) {
    const Rows all_cues = Stack(pairs, &StandardPair::cues),
               all_poses = Stack(pairs, &StandardPair::follower);
    leader_ = PoseSpace(all_cues, kLeaderComponents);
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

  Rows Predict(const StandardPair& leader) const override {
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

std::unique_ptr<ClassModel> LearnMaxEntIoc(const std::vector<StandardPair>& pairs) {
  return std::make_unique<MaxEntIoc>(pairs);
}

}  // namespace duet::evaluation::baselines
