#include "model/evaluation/baselines/maxent_ioc.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "model/evaluation/baselines/kmeans.h"
#include "model/evaluation/baselines/sample_index.h"

namespace duet::evaluation::baselines {
namespace {

constexpr double kValueRidge = 1e-3;
constexpr double kRate = 0.5;  // rate of the exponentiated gradient
constexpr double kLeastWeight = 1e-3, kMostWeight = 1e4;
constexpr double kLeastFeature = 1e-9;

Rows WithConstant(const Rows& rows) {
  Rows out(rows.rows(), rows.cols() + 1);
  out << rows, Eigen::VectorXd::Ones(rows.rows());
  return out;
}

Eigen::MatrixXd SquaredDistances(const Rows& a, const Rows& b) {
  Eigen::MatrixXd distances = -2 * a * b.transpose();
  distances.colwise() += a.rowwise().squaredNorm();
  distances.rowwise() += b.rowwise().squaredNorm().transpose();
  return distances.cwiseMax(0);
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

}  // namespace

Rows MaxEntIoc::Basis(const Model& model, const Eigen::MatrixXd& squared) {
  // Relative to the nearest centre, so that the sum never underflows. Normalisation bounds the
  // values of poses far from all centres by those near them.
  const Eigen::VectorXd nearest = squared.rowwise().minCoeff();
  Rows basis = (-(squared.colwise() - nearest) / (2 * model.width * model.width)).array().exp();
  basis.array().colwise() /= basis.rowwise().sum().array().eval();
  return basis;
}

void MaxEntIoc::PrepareActions(const Rows& changes, Model* model) const {
  model->actions = KMeans(changes, options_.actions, options_.seed);
  Eigen::VectorXd counts = Eigen::VectorXd::Ones(model->actions.rows());
  for (const int action : NearestCentres(model->actions, changes)) counts(action) += 1;
  model->usual = (counts / counts.sum()).array().log();
}

void MaxEntIoc::PrepareValues(const Rows& poses, Model* model) const {
  model->centres = KMeans(poses, options_.value_centres, options_.seed);
  model->width = MeanSpacing(model->centres);
  model->samples = Thin(poses, options_.value_samples);
  model->arrivals = OuterSum(model->samples, model->actions);
  const Eigen::MatrixXd squared = SquaredDistances(model->arrivals, model->centres);
  model->arrival_basis = Basis(*model, squared);
  model->arrival_costs = Costs::Zero(squared.rows(), kFeatures);
  model->arrival_costs.col(1) =
      model->actions.rowwise().squaredNorm().replicate(model->samples.rows(), 1);
  model->arrival_costs.col(2) = model->arrivals.rowwise().squaredNorm();
  const Rows basis = Basis(*model, SquaredDistances(model->samples, model->centres));
  Eigen::MatrixXd normal = basis.transpose() * basis;
  normal.diagonal().array() += kValueRidge;
  model->fit = normal.ldlt().solve(Eigen::MatrixXd(basis.transpose()));
}

Rows MaxEntIoc::SoftValues(const Model& model, const Rows& expected) {
  const Eigen::Index actions = model.actions.rows(), samples = model.samples.rows();
  const Eigen::VectorXd fixed = model.arrival_costs * model.weights;
  Rows values = Rows::Zero(expected.rows(), model.arrival_basis.cols());
  for (Eigen::Index t = expected.rows() - 2; t >= 0; --t) {
    // V_t(s) = log sum_a p(a) exp(r(s, s + a) + V_{t+1}(s + a)), fitted on the samples.
    const Eigen::VectorXd totals =
        model.arrival_basis * values.row(t + 1).transpose() - fixed -
        model.weights(0) * (model.arrivals.rowwise() - expected.row(t + 1)).rowwise().squaredNorm();
    Eigen::VectorXd targets(samples);
    for (Eigen::Index i = 0; i < samples; ++i) {
      const Eigen::VectorXd choices = totals.segment(i * actions, actions) + model.usual;
      const double largest = choices.maxCoeff();
      targets(i) = largest + std::log((choices.array() - largest).exp().sum());
    }
    values.row(t) = (model.fit * targets).transpose();
  }
  return values;
}

MaxEntIoc::Rollouts MaxEntIoc::Sample(const Model& model, const Rows& expected, int paths,
                                      base::Random* random) {
  const Rows values = SoftValues(model, expected);
  const Eigen::Index actions = model.actions.rows();
  const Eigen::VectorXd effort = model.actions.rowwise().squaredNorm();
  Rollouts rollouts;
  rollouts.mean.resize(expected.rows(), expected.cols());
  rollouts.mean.row(0) = expected.row(0);
  Rows poses = expected.row(0).replicate(paths, 1);
  for (Eigen::Index t = 1; t < expected.rows(); ++t) {
    const Rows next = OuterSum(poses, model.actions);
    Costs costs(next.rows(), kFeatures);
    costs.col(0) = (next.rowwise() - expected.row(t)).rowwise().squaredNorm();
    costs.col(1) = effort.replicate(paths, 1);
    costs.col(2) = next.rowwise().squaredNorm();
    const Eigen::VectorXd totals =
        Basis(model, SquaredDistances(next, model.centres)) * values.row(t).transpose() -
        costs * model.weights;
    for (int path = 0; path < paths; ++path) {
      const Eigen::VectorXd choices = totals.segment(path * actions, actions) + model.usual;
      const Eigen::VectorXd policy = (choices.array() - choices.maxCoeff()).exp();
      const Eigen::Index pick = path * actions + SampleIndex(policy, random);
      poses.row(path) = next.row(pick);
      rollouts.costs += costs.row(pick).transpose() / paths;
    }
    rollouts.mean.row(t) = poses.colwise().mean();
  }
  return rollouts;
}

MaxEntIoc::Demonstration MaxEntIoc::Demonstrate(Rows expected, Rows poses) {
  Demonstration one = {std::move(expected), std::move(poses), Weights::Zero()};
  const Eigen::Index steps = one.poses.rows() - 1;
  one.costs(0) = (one.poses - one.expected).bottomRows(steps).squaredNorm();
  one.costs(1) = Changes(one.poses).squaredNorm();
  one.costs(2) = one.poses.bottomRows(steps).squaredNorm();
  return one;
}

void MaxEntIoc::LearnReward(const std::vector<Demonstration>& demonstrations, Model* model) const {
  base::Random random(options_.seed);
  // Initial weights: those of independent Gaussians with the demonstrations' spread.
  Weights total = Weights::Constant(kLeastFeature);
  double steps = 0;
  for (const Demonstration& one : demonstrations) {
    total += one.costs;
    steps += static_cast<double>(one.poses.rows() - 1);
  }
  const double freedom = steps * static_cast<double>(model->samples.cols());
  model->weights = 0.5 * freedom * total.cwiseInverse();
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    Weights excess = Weights::Zero(), scale = Weights::Constant(kLeastFeature);
    for (int i = 0; i < options_.demonstrations; ++i) {
      const auto drawn = random.Below(static_cast<int64_t>(demonstrations.size()));
      const Demonstration& one = demonstrations[static_cast<size_t>(drawn)];
      excess += Sample(*model, one.expected, options_.rollouts, &random).costs - one.costs;
      scale += one.costs;
    }
    // Raise the weight of costs that the policy incurs more than people do.
    const Weights step = excess.cwiseQuotient(scale).cwiseMax(-1).cwiseMin(1);
    const double rate = kRate / std::sqrt(1.0 + iteration);
    model->weights = model->weights.cwiseProduct((rate * step).array().exp().matrix())
                         .cwiseMax(kLeastWeight)
                         .cwiseMin(kMostWeight);
  }
}

void MaxEntIoc::TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) {
  Model& model = models_[static_cast<size_t>(interaction_class)];
  const Rows all_cues =
      StackRows(pairs, [](const StandardPair& p) -> const Rows& { return p.cues; });
  const Rows all_poses =
      StackRows(pairs, [](const StandardPair& p) -> const Rows& { return p.follower; });
  model.leader = PoseSpace(all_cues, options_.leader_components);
  model.follower = PoseSpace(all_poses, options_.pose_components);
  const Rows cues = model.leader.Project(all_cues), poses = model.follower.Project(all_poses);
  model.regression = FitRegression(cues, poses, options_.ridge);
  std::vector<Rows> changes;
  Eigen::Index first = 0;
  for (const StandardPair& pair : pairs) {
    changes.push_back(Changes(poses.middleRows(first, pair.cues.rows())));
    first += pair.cues.rows();
  }
  PrepareActions(StackRows(changes, [](const Rows& rows) -> const Rows& { return rows; }), &model);
  PrepareValues(poses, &model);
  std::vector<Demonstration> demonstrations;
  first = 0;
  for (const StandardPair& pair : pairs) {
    const Eigen::Index frames = pair.cues.rows();
    // Fitted without the clip, which the regression would otherwise memorise.
    const Eigen::MatrixXd regression =
        pairs.size() == 1 ? model.regression
                          : FitRegression(Without(cues, first, frames),
                                          Without(poses, first, frames), options_.ridge);
    demonstrations.push_back(Demonstrate(WithConstant(cues.middleRows(first, frames)) * regression,
                                         poses.middleRows(first, frames)));
    first += frames;
  }
  LearnReward(demonstrations, &model);
}

Rows MaxEntIoc::PredictClass(int interaction_class, const StandardPair& leader) const {
  const Model& model = models_[static_cast<size_t>(interaction_class)];
  const Rows expected = WithConstant(model.leader.Project(leader.cues)) * model.regression;
  base::Random random(options_.seed);
  return model.follower.Reconstruct(
      Sample(model, expected, options_.answer_rollouts, &random).mean);
}

}  // namespace duet::evaluation::baselines
