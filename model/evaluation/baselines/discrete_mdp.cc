#include "model/evaluation/baselines/class_models.h"

namespace duet::evaluation::baselines {
namespace {

constexpr int kPoseStates = 16;   // clusters of follower poses
constexpr int kLeaderStates = 8;  // clusters of leader cues
constexpr int kComponents = 10;   // principal components in which poses and cues are clustered
constexpr int kIterations = 30;   // gradient steps on the reward
constexpr uint64_t kSeed = 1;
// Pseudo-counts: unseen events stay possible.
constexpr double kCount = 0.1;
// Gradient ascent on the mean log-likelihood of a frame: rate, and pull towards the initial
// weights.
constexpr double kRate = 0.3;
constexpr double kPull = 0.01;

// Weights of the features of arriving at a pose: how well it matches the leader's cluster, how
// frequent the step is, how little the pose changes.
using Weights = Eigen::Vector3d;

// log p(column | row) from counts.
Eigen::MatrixXd LogConditional(const Eigen::MatrixXd& counts) {
  const Eigen::MatrixXd padded = counts.array() + kCount;
  return (padded.array().colwise() / padded.rowwise().sum().array()).log();
}

// A training sequence as cluster indices.
struct Demonstration {
  std::vector<int> leader;
  std::vector<int> pose;
};

// How often clusters occur together.
struct Counts {
  Counts(Eigen::Index poses, Eigen::Index leaders)
      : together(Eigen::MatrixXd::Zero(poses, leaders)),
        steps(Eigen::MatrixXd::Zero(poses, poses)),
        starts(Eigen::MatrixXd::Zero(1, poses)) {}

  void Add(const Demonstration& one, double times) {
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
      : leader_given_pose(LogConditional(counts.together).transpose()),
        step(LogConditional(counts.steps)),
        start(LogConditional(counts.starts)) {}

  Rows leader_given_pose;    // [leader, pose]
  Eigen::MatrixXd step;      // [from, to]
  Eigen::RowVectorXd start;  // [pose]
};

class DiscreteMdp : public ClassModel {
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
    std::vector<Demonstration> demonstrations;
    Counts counts(pose_centres_.rows(), leader_centres_.rows());
    for (const StandardPair& pair : pairs) {
      demonstrations.push_back({NearestCentres(leader_centres_, leader_.Project(pair.cues)),
                                NearestCentres(pose_centres_, follower_.Project(pair.follower))});
      counts.Add(demonstrations.back(), 1);
    }
    tables_ = Tables(counts);
    LearnReward(demonstrations, counts);
  }

  Rows Predict(const StandardPair& leader) const override {
    const std::vector<int> seen = NearestCentres(leader_centres_, leader_.Project(leader.cues));
    return follower_.Reconstruct(Visits(tables_, seen) * pose_centres_);
  }

 private:
  void LearnReward(const std::vector<Demonstration>& demonstrations, const Counts& counts) {
    // Each demonstration is explained by the counts of the others: its own would overfit.
    std::vector<Tables> others;
    double frames = 0;
    for (const Demonstration& one : demonstrations) {
      Counts rest = counts;
      if (demonstrations.size() > 1) rest.Add(one, -1);
      others.emplace_back(rest);
      frames += static_cast<double>(one.pose.size());
    }
    const Weights initial = Weights(1, 1, 0);
    weights_ = initial;
    Weights squares = Weights::Constant(1e-12);
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      Weights gradient = Weights::Zero();
      for (size_t i = 0; i < demonstrations.size(); ++i) {
        gradient += Surplus(others[i], demonstrations[i]);
      }
      gradient = gradient / frames - kPull * (weights_ - initial);
      squares += gradient.cwiseAbs2();
      weights_ += kRate * gradient.cwiseQuotient(squares.cwiseSqrt());
    }
  }

  // Features of the demonstration minus the policy's expected features.
  Weights Surplus(const Tables& tables, const Demonstration& one) const {
    Eigen::MatrixXd steps = Eigen::MatrixXd::Zero(effort_.rows(), effort_.cols());
    const Rows visits = Visits(tables, one.leader, &steps);
    Weights surplus(0, tables.start(one.pose[0]) - visits.row(0).dot(tables.start), 0);
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
  Weights weights_;
};

}  // namespace

std::unique_ptr<ClassModel> LearnDiscreteMdp(const std::vector<StandardPair>& pairs) {
  return std::make_unique<DiscreteMdp>(pairs);
}

}  // namespace duet::evaluation::baselines
