#include "model/evaluation/baselines/maxent_ioc.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "model/evaluation/baselines/kmeans.h"
#include "model/evaluation/baselines/uniform.h"

namespace duet {
namespace {

constexpr double kValueRidge = 1e-3;
constexpr double kRate = 0.5;  // of the exponentiated gradient
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

// At most `count` rows, evenly.
Rows Thin(const Rows& rows, Eigen::Index count) {
  if (rows.rows() <= count) return rows;
  Rows kept(count, rows.cols());
  for (Eigen::Index i = 0; i < count; ++i) kept.row(i) = rows.row(i * rows.rows() / count);
  return kept;
}

}  // namespace

MaxEntIoc::Regression MaxEntIoc::FitRegression(const Rows& cues, const Rows& poses, double ridge) {
  const Rows inputs = WithConstant(cues);
  Eigen::MatrixXd normal = inputs.transpose() * inputs;
  // The constant is not drawn to zero.
  normal.diagonal().head(cues.cols()).array() += ridge;
  return normal.ldlt().solve(inputs.transpose() * poses);
}

Rows MaxEntIoc::ApplyRegression(const Regression& regression, const Rows& cues) {
  return WithConstant(cues) * regression;
}

Rows MaxEntIoc::Basis(const Model& model, const Rows& poses) {
  Rows basis(poses.rows(), 1 + poses.cols() + model.centres.rows());
  const Eigen::MatrixXd squared = SquaredDistances(poses, model.centres);
  basis << Eigen::VectorXd::Ones(poses.rows()), poses,
      (-squared / (2 * model.width * model.width)).array().exp().matrix();
  return basis;
}

Eigen::Matrix<double, Eigen::Dynamic, MaxEntIoc::kFeatures> MaxEntIoc::Features(
    const Model& model, const Rows& next, const Rows& before, const Eigen::RowVectorXd& expected) {
  Eigen::Matrix<double, Eigen::Dynamic, kFeatures> features(next.rows(), kFeatures);
  features.col(0) = (next.rowwise() - expected).rowwise().squaredNorm();
  features.col(1) = (next - before).rowwise().squaredNorm();
  features.col(2) = SquaredDistances(next, model.centres).rowwise().minCoeff();
  return features;
}

void MaxEntIoc::PrepareValues(const Rows& poses, Model* model) const {
  model->centres = KMeans(poses, options_.value_centres, options_.seed);
  model->width = 2 * MeanSpacing(model->centres);
  model->samples = Thin(poses, options_.value_samples);
  const Eigen::Index actions = model->actions.rows();
  model->arrivals.resize(model->samples.rows() * actions, poses.cols());
  for (Eigen::Index i = 0; i < model->samples.rows(); ++i) {
    model->arrivals.middleRows(i * actions, actions) =
        model->actions.rowwise() + model->samples.row(i);
  }
  model->arrival_basis = Basis(*model, model->arrivals);
  const Rows basis = Basis(*model, model->samples);
  Eigen::MatrixXd normal = basis.transpose() * basis;
  normal.diagonal().array() += kValueRidge;
  model->fit = normal.ldlt().solve(Eigen::MatrixXd(basis.transpose()));
}

Rows MaxEntIoc::SoftValues(const Model& model, const Rows& expected) {
  const Eigen::Index actions = model.actions.rows(), samples = model.samples.rows();
  Rows before(model.arrivals.rows(), model.arrivals.cols());
  for (Eigen::Index i = 0; i < samples; ++i) {
    before.middleRows(i * actions, actions) = model.samples.row(i).replicate(actions, 1);
  }
  Rows values = Rows::Zero(expected.rows(), model.arrival_basis.cols());
  for (Eigen::Index t = expected.rows() - 2; t >= 0; --t) {
    // V_t(s) = log mean_a exp(r(s, s + a) + V_{t+1}(s + a)), fitted on the samples.
    const Eigen::VectorXd totals =
        model.arrival_basis * values.row(t + 1).transpose() -
        Features(model, model.arrivals, before, expected.row(t + 1)) * model.weights;
    Eigen::VectorXd targets(samples);
    for (Eigen::Index i = 0; i < samples; ++i) {
      const auto choices = totals.segment(i * actions, actions);
      const double largest = choices.maxCoeff();
      targets(i) = largest + std::log((choices.array() - largest).exp().mean());
    }
    values.row(t) = (model.fit * targets).transpose();
  }
  return values;
}

Rows MaxEntIoc::Rollout(const Model& model, const Rows& expected, const Rows& values,
                        std::mt19937_64* random, Weights* features) {
  Rows path(expected.rows(), expected.cols());
  path.row(0) = expected.row(0);
  for (Eigen::Index t = 1; t < path.rows(); ++t) {
    const Rows next = model.actions.rowwise() + path.row(t - 1);
    const auto costs =
        Features(model, next, path.row(t - 1).replicate(next.rows(), 1), expected.row(t));
    const Eigen::VectorXd totals =
        Basis(model, next) * values.row(t).transpose() - costs * model.weights;
    const Eigen::VectorXd policy = (totals.array() - totals.maxCoeff()).exp();
    const Eigen::Index action = SampleIndex(policy, random);
    path.row(t) = next.row(action);
    if (features != nullptr) *features += costs.row(action).transpose();
  }
  return path;
}

void MaxEntIoc::LearnReward(const std::vector<Demonstration>& demonstrations, Model* model) const {
  std::mt19937_64 random(options_.seed);
  // To start with, a reward as of independent Gaussians with the demonstrations' own spread.
  Weights total = Weights::Zero();
  double steps = 0;
  std::vector<Weights> demonstrated;
  for (const Demonstration& one : demonstrations) {
    Weights sum = Weights::Zero();
    for (Eigen::Index t = 1; t < one.poses.rows(); ++t) {
      sum += Features(*model, one.poses.row(t), one.poses.row(t - 1), one.expected.row(t))
                 .row(0)
                 .transpose();
    }
    demonstrated.push_back(sum);
    total += sum;
    steps += static_cast<double>(one.poses.rows() - 1);
  }
  const Weights mean = (total / std::max(steps, 1.0)).cwiseMax(kLeastFeature);
  model->weights = (0.5 * static_cast<double>(model->samples.cols()) / mean.array()).matrix();
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    Weights excess = Weights::Zero(), scale = Weights::Constant(kLeastFeature);
    for (int i = 0; i < options_.demonstrations; ++i) {
      const size_t pick = random() % demonstrations.size();
      const Rows& expected = demonstrations[pick].expected;
      const Rows values = SoftValues(*model, expected);
      Weights sampled = Weights::Zero();
      for (int k = 0; k < options_.rollouts; ++k) {
        Rollout(*model, expected, values, &random, &sampled);
      }
      excess += sampled / options_.rollouts - demonstrated[pick];
      scale += demonstrated[pick];
    }
    // A feature that the policy pays more of than people do must cost more.
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
  std::vector<Demonstration> demonstrations;
  Rows changes(poses.rows(), poses.cols());
  Eigen::Index first = 0;
  for (const StandardPair& pair : pairs) {
    const Eigen::Index frames = pair.cues.rows();
    // Without the clip itself, which the regression would know by heart.
    Rows other_cues(cues.rows() - frames, cues.cols());
    Rows other_poses(other_cues.rows(), poses.cols());
    other_cues << cues.topRows(first), cues.bottomRows(cues.rows() - first - frames);
    other_poses << poses.topRows(first), poses.bottomRows(poses.rows() - first - frames);
    const Regression other = pairs.size() > 1
                                 ? FitRegression(other_cues, other_poses, options_.ridge)
                                 : model.regression;
    demonstrations.push_back(
        {ApplyRegression(other, cues.middleRows(first, frames)), poses.middleRows(first, frames)});
    changes.row(first).setZero();
    changes.middleRows(first + 1, frames - 1) =
        poses.middleRows(first + 1, frames - 1) - poses.middleRows(first, frames - 1);
    first += frames;
  }
  model.actions = KMeans(changes, options_.actions, options_.seed);
  PrepareValues(poses, &model);
  LearnReward(demonstrations, &model);
}

Rows MaxEntIoc::PredictClass(int interaction_class, const StandardPair& leader) const {
  const Model& model = models_[static_cast<size_t>(interaction_class)];
  const Rows expected = ApplyRegression(model.regression, model.leader.Project(leader.cues));
  const Rows values = SoftValues(model, expected);
  std::mt19937_64 random(options_.seed);
  Rows sum = Rows::Zero(expected.rows(), expected.cols());
  for (int i = 0; i < options_.answer_rollouts; ++i) {
    sum += Rollout(model, expected, values, &random, nullptr);
  }
  return model.follower.Reconstruct(sum / options_.answer_rollouts);
}

}  // namespace duet
