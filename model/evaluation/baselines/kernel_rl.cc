#include "model/evaluation/baselines/kernel_rl.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace duet::evaluation::baselines {
namespace {

constexpr double kNever = -1e9;  // log weight of an excluded sample
// Minimum width of a kernel, relative to the root mean squared distance: otherwise repeated takes
// of one motion would make every other motion infinitely far.
constexpr double kLeastWidth = 0.05;
constexpr double kTiny = 1e-9;
// Candidate weights of the reward: powers of two times that of a Gaussian of the cues' own width.
constexpr int kLeastPower = -8, kMostPower = 4;
constexpr int kMeanShifts = 20;

// Squared distances between rows. [a rows, b rows]
Eigen::MatrixXd SquaredDistances(const Rows& a, const Rows& b) {
  Eigen::MatrixXd distances = -2 * a * b.transpose();
  distances.colwise() += a.rowwise().squaredNorm();
  distances.rowwise() += b.rowwise().squaredNorm().transpose();
  return distances.cwiseMax(0);
}

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
  const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2);
  std::nth_element(nearest.begin(), middle, nearest.end());
  return std::max(*middle, least_width);
}

// Rows 0, n, 2 n, ...
Rows EveryNth(const Rows& rows, Eigen::Index n) {
  Rows kept((rows.rows() + n - 1) / n, rows.cols());
  for (Eigen::Index i = 0; i < kept.rows(); ++i) kept.row(i) = rows.row(i * n);
  return kept;
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

}  // namespace

void KernelRl::BuildStep(const std::vector<int>& successor, Model* model) const {
  // A state is a pose and its change: without the change, motion could reverse freely.
  const Eigen::Index samples = model->poses.rows(), width = model->poses.cols();
  Rows states(samples, 2 * width);
  for (Eigen::Index i = 0; i < samples; ++i) {
    const Eigen::Index next = successor[static_cast<size_t>(i)];
    states.row(i) << model->poses.row(i),
        options_.velocity_weight * (model->poses.row(next) - model->poses.row(i));
  }
  model->pose_width = MedianNearest(SquaredDistances(model->poses, model->poses), model->clip);
  const Eigen::MatrixXd squared = SquaredDistances(states, states);
  const double spread = options_.transition_width * MedianNearest(squared, model->clip);
  Eigen::MatrixXd kernel = (-squared / (2 * spread * spread)).array().exp();
  kernel.array().colwise() /= kernel.rowwise().sum().array().eval();
  model->step = Eigen::MatrixXd::Zero(samples, samples);
  for (Eigen::Index like = 0; like < samples; ++like) {
    model->step.col(successor[static_cast<size_t>(like)]) += kernel.col(like);
  }
}

Rows KernelRl::Cost(const Model& model, const Rows& cues) {
  return SquaredDistances(EveryNth(model.leader.Project(cues), model.stride), model.cues);
}

PathPosterior KernelRl::Plan(const Model& model, const Rows& cost, int without) {
  Rows arrivals = -cost;
  for (Eigen::Index i = 0; i < arrivals.cols(); ++i) {
    if (model.clip[static_cast<size_t>(i)] == without) arrivals.col(i).setConstant(kNever);
  }
  return SumOverPaths({Eigen::RowVectorXd::Ones(arrivals.cols()), model.step}, arrivals);
}

void KernelRl::LearnReward(const std::vector<StandardPair>& pairs, Model* model) const {
  const double cue_width = MedianNearest(SquaredDistances(model->cues, model->cues), model->clip);
  double best = -std::numeric_limits<double>::infinity();
  for (int power = kLeastPower; power <= kMostPower; ++power) {
    const double weight = std::pow(2, power) / (2 * cue_width * cue_width);
    const double likelihood = LogLikelihood(*model, pairs, weight);
    if (likelihood <= best) continue;
    best = likelihood;
    model->reward_weight = weight;
  }
}

// The log-likelihood of the demonstrated poses, each as a sample's pose with Gaussian noise.
// Excludes a clip's own samples, which would overfit.
double KernelRl::LogLikelihood(const Model& model, const std::vector<StandardPair>& pairs,
                               double weight) const {
  const size_t stride =
      std::max<size_t>(1, pairs.size() / static_cast<size_t>(options_.demonstrations));
  const double precision = 1 / (2 * model.pose_width * model.pose_width);
  double sum = 0;
  for (size_t i = 0; pairs.size() > 1 && i < pairs.size(); i += stride) {
    const int clip = static_cast<int>(i);
    const Rows cost = weight * Cost(model, pairs[i].cues);
    const Rows noise =
        precision *
        SquaredDistances(EveryNth(model.follower.Project(pairs[i].follower), model.stride),
                         model.poses);
    sum += Plan(model, cost + noise, clip).log_sum - Plan(model, cost, clip).log_sum;
  }
  return sum;
}

void KernelRl::TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) {
  Model& model = models_[static_cast<size_t>(interaction_class)];
  const Rows cues = StackRows(pairs, [](const StandardPair& p) -> const Rows& { return p.cues; });
  const Rows poses =
      StackRows(pairs, [](const StandardPair& p) -> const Rows& { return p.follower; });
  model.leader = PoseSpace(cues, options_.components);
  model.follower = PoseSpace(poses, options_.components);
  model.stride = (cues.rows() + options_.most_samples - 1) / options_.most_samples;
  std::vector<Eigen::Index> kept;
  std::vector<int> successor;
  Eigen::Index first = 0;
  for (size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Index frames = pairs[i].cues.rows();
    for (Eigen::Index t = 0; t < frames; t += model.stride) {
      const int index = static_cast<int>(kept.size());
      kept.push_back(first + t);
      model.clip.push_back(static_cast<int>(i));
      // A clip's last pose follows itself.
      successor.push_back(t + model.stride < frames ? index + 1 : index);
    }
    first += frames;
  }
  model.cues = model.leader.Project(cues(kept, Eigen::all));
  model.poses = model.follower.Project(poses(kept, Eigen::all));
  BuildStep(successor, &model);
  LearnReward(pairs, &model);
}

Rows KernelRl::MeanShift(const Model& model, const Rows& visits) const {
  const double width = options_.decoding_width * model.pose_width;
  Rows poses(visits.rows(), model.poses.cols());
  for (Eigen::Index t = 0; t < visits.rows(); ++t) {
    Eigen::Index likeliest = 0;
    visits.row(t).maxCoeff(&likeliest);
    Rows pose = model.poses.row(likeliest);
    for (int i = 0; i < kMeanShifts; ++i) {
      const Eigen::RowVectorXd kernel =
          (-SquaredDistances(pose, model.poses) / (2 * width * width)).array().exp();
      const Eigen::RowVectorXd weights = kernel.cwiseProduct(visits.row(t));
      pose = weights * model.poses / weights.sum();
    }
    poses.row(t) = pose;
  }
  return poses;
}

Rows KernelRl::PredictClass(int interaction_class, const StandardPair& leader) const {
  const Model& model = models_[static_cast<size_t>(interaction_class)];
  const Rows visits =
      Plan(model, model.reward_weight * Cost(model, leader.cues), /*without=*/-1).states;
  return model.follower.Reconstruct(
      FillBetween(MeanShift(model, visits), model.stride, leader.cues.rows()));
}

}  // namespace duet::evaluation::baselines
