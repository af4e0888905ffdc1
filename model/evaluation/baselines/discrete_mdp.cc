#include "model/evaluation/baselines/discrete_mdp.h"

#include <cmath>

#include "model/evaluation/baselines/kmeans.h"

namespace duet {
namespace {

// Pseudo-counts: what was never seen stays possible.
constexpr double kCount = 0.1;
// Ascent on the mean log-likelihood of a frame: rate, and pull towards the starting weights.
constexpr double kRate = 0.3;
constexpr double kPull = 0.01;

// log p(column | row) from counts.
Eigen::MatrixXd LogConditional(const Eigen::MatrixXd& counts) {
  const Eigen::MatrixXd padded = counts.array() + kCount;
  return (padded.array().colwise() / padded.rowwise().sum().array()).log();
}

}  // namespace

void DiscreteMdp::CountStatistics(const std::vector<Demonstration>& demonstrations,
                                  Model* model) const {
  const Eigen::Index poses = model->pose_centres.rows(), leaders = model->leader_centres.rows();
  Eigen::MatrixXd together = Eigen::MatrixXd::Zero(poses, leaders);
  Eigen::MatrixXd steps = Eigen::MatrixXd::Zero(poses, poses);
  Eigen::MatrixXd starts = Eigen::MatrixXd::Zero(1, poses);
  for (const Demonstration& one : demonstrations) {
    ++starts(0, one.pose[0]);
    for (size_t t = 0; t < one.pose.size(); ++t) {
      ++together(one.pose[t], one.leader[t]);
      if (t > 0) ++steps(one.pose[t - 1], one.pose[t]);
    }
  }
  model->log_leader_given_pose = LogConditional(together).transpose();
  model->log_step = LogConditional(steps);
  model->log_start = LogConditional(starts);
  model->effort.resize(poses, poses);
  for (Eigen::Index from = 0; from < poses; ++from) {
    model->effort.row(from) =
        -(model->pose_centres.rowwise() - model->pose_centres.row(from)).rowwise().squaredNorm();
  }
}

ChainWeights DiscreteMdp::Chain(const Model& model) {
  return {(model.weights(1) * model.log_start).array().exp(),
          (model.weights(1) * model.log_step + model.weights(2) * model.effort).array().exp()};
}

Rows DiscreteMdp::Arrivals(const Model& model, const std::vector<int>& leader) {
  Rows arrivals(leader.size(), model.pose_centres.rows());
  for (size_t t = 0; t < leader.size(); ++t) {
    arrivals.row(static_cast<Eigen::Index>(t)) =
        model.weights(0) * model.log_leader_given_pose.row(leader[t]);
  }
  return arrivals;
}

void DiscreteMdp::LearnReward(const std::vector<Demonstration>& demonstrations,
                              Model* model) const {
  const Weights initial = Weights(1, 1, 0);
  model->weights = initial;
  double frames = 0;
  for (const Demonstration& one : demonstrations) frames += static_cast<double>(one.pose.size());
  Weights squares = Weights::Constant(1e-12);
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    const ChainWeights chain = Chain(*model);
    Weights gradient = Weights::Zero();  // features of the demonstrations less the expected ones
    for (const Demonstration& one : demonstrations) {
      Eigen::MatrixXd steps = Eigen::MatrixXd::Zero(chain.step.rows(), chain.step.cols());
      const PathPosterior plan = SumOverPaths(chain, Arrivals(*model, one.leader), &steps);
      for (size_t t = 0; t < one.pose.size(); ++t) {
        const auto fit = model->log_leader_given_pose.row(one.leader[t]);
        gradient(0) += fit(one.pose[t]) - plan.states.row(static_cast<Eigen::Index>(t)).dot(fit);
        if (t == 0) continue;
        gradient(1) += model->log_step(one.pose[t - 1], one.pose[t]);
        gradient(2) += model->effort(one.pose[t - 1], one.pose[t]);
      }
      gradient(1) -= steps.cwiseProduct(model->log_step).sum();
      gradient(2) -= steps.cwiseProduct(model->effort).sum();
    }
    gradient = gradient / frames - kPull * (model->weights - initial);
    squares += gradient.cwiseAbs2();
    model->weights += kRate * gradient.cwiseQuotient(squares.cwiseSqrt());
  }
}

void DiscreteMdp::TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) {
  Model& model = models_[static_cast<size_t>(interaction_class)];
  const Rows cues = StackRows(pairs, [](const StandardPair& p) -> const Rows& { return p.cues; });
  const Rows poses =
      StackRows(pairs, [](const StandardPair& p) -> const Rows& { return p.follower; });
  model.leader = PoseSpace(cues, options_.components);
  model.follower = PoseSpace(poses, options_.components);
  model.leader_centres = KMeans(model.leader.Project(cues), options_.leader_states, options_.seed);
  model.pose_centres = KMeans(model.follower.Project(poses), options_.pose_states, options_.seed);
  std::vector<Demonstration> demonstrations;
  for (const StandardPair& pair : pairs) {
    demonstrations.push_back(
        {NearestCentres(model.leader_centres, model.leader.Project(pair.cues)),
         NearestCentres(model.pose_centres, model.follower.Project(pair.follower))});
  }
  CountStatistics(demonstrations, &model);
  LearnReward(demonstrations, &model);
}

Rows DiscreteMdp::PredictClass(int interaction_class, const StandardPair& leader) const {
  const Model& model = models_[static_cast<size_t>(interaction_class)];
  const std::vector<int> seen =
      NearestCentres(model.leader_centres, model.leader.Project(leader.cues));
  const Rows arrivals = Arrivals(model, seen);
  if (options_.expected_pose) {
    const Rows visits = SumOverPaths(Chain(model), arrivals).states;
    return model.follower.Reconstruct(visits * model.pose_centres);
  }
  const std::vector<int> path = BestPath(Chain(model), arrivals);
  Rows poses(arrivals.rows(), model.pose_centres.cols());
  for (Eigen::Index t = 0; t < poses.rows(); ++t) {
    poses.row(t) = model.pose_centres.row(path[static_cast<size_t>(t)]);
  }
  return model.follower.Reconstruct(poses);
}

}  // namespace duet
