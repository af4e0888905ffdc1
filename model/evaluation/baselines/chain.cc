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

}  // namespace duet::evaluation::baselines
