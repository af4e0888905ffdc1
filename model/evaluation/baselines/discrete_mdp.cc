#include "model/evaluation/baselines/discrete_mdp.h"

#include <cmath>

#include "model/evaluation/baselines/kmeans.h"

namespace duet::evaluation::baselines {
namespace {

// Pseudo-counts: unseen events stay possible.
constexpr double kCount = 0.1;
// Gradient ascent on the mean log-likelihood of a frame: rate, and pull towards the initial
// weights.
constexpr double kRate = 0.3;
constexpr double kPull = 0.01;

// log p(column | row) from counts.
Eigen::MatrixXd LogConditional(const Eigen::MatrixXd& counts) {
  const Eigen::MatrixXd padded = counts.array() + kCount;
  return (padded.array().colwise() / padded.rowwise().sum().array()).log();
}

}  // namespace

DiscreteMdp::Counts::Counts(Eigen::Index poses, Eigen::Index leaders)
    : together(Eigen::MatrixXd::Zero(poses, leaders)),
      steps(Eigen::MatrixXd::Zero(poses, poses)),
      starts(Eigen::MatrixXd::Zero(1, poses)) {}

void DiscreteMdp::Counts::Add(const Demonstration& one, double times) {
  starts(0, one.pose[0]) += times;
  for (size_t t = 0; t < one.pose.size(); ++t) {
    together(one.pose[t], one.leader[t]) += times;
    if (t > 0) steps(one.pose[t - 1], one.pose[t]) += times;
  }
}

DiscreteMdp::Tables::Tables(const Counts& counts)
    : leader_given_pose(LogConditional(counts.together).transpose()),
      step(LogConditional(counts.steps)),
      start(LogConditional(counts.starts)) {}

ChainWeights DiscreteMdp::Chain(const Model& model, const Tables& tables) {
  return {(model.weights(1) * tables.start).array().exp(),
          (model.weights(1) * tables.step + model.weights(2) * model.effort).array().exp()};
}

Rows DiscreteMdp::Arrivals(const Model& model, const Tables& tables,
                           const std::vector<int>& leader) {
  Rows arrivals(leader.size(), model.pose_centres.rows());
  for (size_t t = 0; t < leader.size(); ++t) {
    arrivals.row(static_cast<Eigen::Index>(t)) =
        model.weights(0) * tables.leader_given_pose.row(leader[t]);
  }
  return arrivals;
}

DiscreteMdp::Weights DiscreteMdp::Surplus(const Model& model, const Tables& tables,
                                          const Demonstration& one) {
  const ChainWeights chain = Chain(model, tables);
  Eigen::MatrixXd steps = Eigen::MatrixXd::Zero(chain.step.rows(), chain.step.cols());
  const Rows visits = SumOverPaths(chain, Arrivals(model, tables, one.leader), &steps).states;
  Weights surplus(0, tables.start(one.pose[0]) - visits.row(0).dot(tables.start), 0);
  for (size_t t = 0; t < one.pose.size(); ++t) {
    const auto fit = tables.leader_given_pose.row(one.leader[t]);
    surplus(0) += fit(one.pose[t]) - visits.row(static_cast<Eigen::Index>(t)).dot(fit);
    if (t > 0) steps(one.pose[t - 1], one.pose[t]) -= 1;
  }
  surplus(1) -= steps.cwiseProduct(tables.step).sum();
  surplus(2) -= steps.cwiseProduct(model.effort).sum();
  return surplus;
}

void DiscreteMdp::LearnReward(const std::vector<Demonstration>& demonstrations,
                              const Counts& counts, Model* model) const {
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
  model->weights = initial;
  Weights squares = Weights::Constant(1e-12);
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    Weights gradient = Weights::Zero();
    for (size_t i = 0; i < demonstrations.size(); ++i) {
      gradient += Surplus(*model, others[i], demonstrations[i]);
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
  model.effort.resize(model.pose_centres.rows(), model.pose_centres.rows());
  for (Eigen::Index from = 0; from < model.effort.rows(); ++from) {
    model.effort.row(from) =
        -(model.pose_centres.rowwise() - model.pose_centres.row(from)).rowwise().squaredNorm();
  }
  Counts counts(model.pose_centres.rows(), model.leader_centres.rows());
  for (const Demonstration& one : demonstrations) counts.Add(one, 1);
  model.tables = Tables(counts);
  LearnReward(demonstrations, counts, &model);
}

Rows DiscreteMdp::PredictClass(int interaction_class, const StandardPair& leader) const {
  const Model& model = models_[static_cast<size_t>(interaction_class)];
  const std::vector<int> seen =
      NearestCentres(model.leader_centres, model.leader.Project(leader.cues));
  const Rows arrivals = Arrivals(model, model.tables, seen);
  if (options_.expected_pose) {
    const Rows visits = SumOverPaths(Chain(model, model.tables), arrivals).states;
    return model.follower.Reconstruct(visits * model.pose_centres);
  }
  const std::vector<int> path = BestPath(Chain(model, model.tables), arrivals);
  Rows poses(arrivals.rows(), model.pose_centres.cols());
  for (Eigen::Index t = 0; t < poses.rows(); ++t) {
    poses.row(t) = model.pose_centres.row(path[static_cast<size_t>(t)]);
  }
  return model.follower.Reconstruct(poses);
}

}  // namespace duet::evaluation::baselines
