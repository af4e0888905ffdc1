#include "model/evaluation/baselines/chain.h"

#include <cmath>

namespace duet::evaluation::baselines {

PathPosterior SumOverPaths(const ChainWeights& chain, const Rows& log_arrivals,
                           Eigen::MatrixXd* steps) {
  const Eigen::Index frames = log_arrivals.rows(), states = log_arrivals.cols();
  // Relative to each frame's largest, and messages that sum to one: no underflow.
  const Eigen::VectorXd largest = log_arrivals.rowwise().maxCoeff();
  const Rows arrivals = (log_arrivals.colwise() - largest).array().exp();
  Rows forward(frames, states), backward(frames, states);
  PathPosterior posterior;
  posterior.log_sum = largest.sum();
  for (Eigen::Index t = 0; t < frames; ++t) {
    if (t == 0) {
      forward.row(t) = chain.start;
    } else {
      forward.row(t).noalias() = forward.row(t - 1) * chain.step;
    }
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

std::vector<int> BestPath(const ChainWeights& chain, const Rows& log_arrivals) {
  const Eigen::Index frames = log_arrivals.rows(), states = log_arrivals.cols();
  const Eigen::MatrixXd log_step = chain.step.array().log();
  Eigen::MatrixXi best_from(frames, states);
  Eigen::VectorXd value =
      chain.start.array().log().matrix().transpose() + log_arrivals.row(0).transpose();
  for (Eigen::Index t = 1; t < frames; ++t) {
    Eigen::VectorXd next(states);
    for (Eigen::Index to = 0; to < states; ++to) {
      Eigen::Index from = 0;
      next(to) = (value + log_step.col(to)).maxCoeff(&from) + log_arrivals(t, to);
      best_from(t, to) = static_cast<int>(from);
    }
    value = next;
  }
  std::vector<int> path(static_cast<size_t>(frames));
  Eigen::Index last = 0;
  value.maxCoeff(&last);
  for (Eigen::Index t = frames - 1; t >= 0; --t) {
    path[static_cast<size_t>(t)] = static_cast<int>(last);
    if (t > 0) last = best_from(t, last);
  }
  return path;
}

}  // namespace duet::evaluation::baselines
