#include "model/evaluation/baselines/chain.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace duet::evaluation::baselines {
namespace {

constexpr double kLogTwoPi = 1.8378770664093453;
// Pseudo-counts that keep every start and every transition possible.
constexpr double kStartCount = 0.1;
constexpr double kTransitionCount = 0.1;

// Every sequence cut into as many pieces of the same length as there are states.
std::vector<Rows> EvenCut(const std::vector<Rows>& sequences, int states) {
  std::vector<Rows> posteriors;
  for (const Rows& sequence : sequences) {
    Rows posterior = Rows::Zero(sequence.rows(), states);
    for (Eigen::Index t = 0; t < sequence.rows(); ++t) {
      posterior(t, t * states / sequence.rows()) = 1;
    }
    posteriors.push_back(std::move(posterior));
  }
  return posteriors;
}

// Transition counts of a hard assignment of frames to states.
Eigen::MatrixXd CountJumps(const std::vector<Rows>& posteriors) {
  const Eigen::Index states = posteriors[0].cols();
  Eigen::MatrixXd jumps = Eigen::MatrixXd::Zero(states, states);
  for (const Rows& posterior : posteriors) {
    const Eigen::Index steps = posterior.rows() - 1;
    jumps += posterior.topRows(steps).transpose() * posterior.bottomRows(steps);
  }
  return jumps;
}

Eigen::MatrixXd RowsToProbabilities(const Eigen::MatrixXd& counts, double pseudo_count) {
  const Eigen::MatrixXd padded = counts.array() + pseudo_count;
  return padded.array().colwise() / padded.rowwise().sum().array();
}

Eigen::RowVectorXd PooledVariance(const std::vector<Rows>& sequences) {
  double frames = 0;
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(sequences[0].cols()), squares = sum;
  for (const Rows& sequence : sequences) {
    frames += static_cast<double>(sequence.rows());
    sum += sequence.colwise().sum();
    squares += sequence.cwiseAbs2().colwise().sum();
  }
  return (squares / frames - (sum / frames).cwiseAbs2()).cwiseMax(0);
}

}  // namespace

PathPosterior SumOverPaths(const ChainWeights& chain, const Rows& log_arrivals,
                           Eigen::MatrixXd* steps) {
  const Eigen::Index frames = log_arrivals.rows(), states = log_arrivals.cols();
  // Relative to each frame's largest, and messages that sum to one: no underflow.
  const Eigen::VectorXd largest = log_arrivals.rowwise().maxCoeff();
  const Rows arrivals = (log_arrivals.colwise() - largest).array().exp();
  Rows forward(frames, states), backward(frames, states);
  PathPosterior posterior;
  posterior.log_sum = largest.sum();
  forward.row(0) = chain.start;
  for (Eigen::Index t = 0; t < frames; ++t) {
    if (t > 0) forward.row(t).noalias() = forward.row(t - 1) * chain.step;
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

GaussianHmm::GaussianHmm(const std::vector<Rows>& sequences, const GaussianHmmOptions& options) {
  const Eigen::Index states = options.states;
  states_.resize(static_cast<size_t>(options.states));
  std::vector<Rows> posteriors = EvenCut(sequences, options.states);
  Maximise(sequences, posteriors, options);
  chain_.step = RowsToProbabilities(CountJumps(posteriors), kTransitionCount);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    Eigen::MatrixXd jumps = Eigen::MatrixXd::Zero(states, states);
    for (size_t i = 0; i < sequences.size(); ++i) {
      posteriors[i] = SumOverPaths(chain_, LogDensities(sequences[i]), &jumps).states;
    }
    Maximise(sequences, posteriors, options);
    chain_.step = RowsToProbabilities(jumps, kTransitionCount);
  }
}

void GaussianHmm::Maximise(const std::vector<Rows>& sequences, const std::vector<Rows>& posteriors,
                           const GaussianHmmOptions& options) {
  // A few samples do not determine a full covariance: the pooled diagonal one adds some.
  const Eigen::RowVectorXd prior = PooledVariance(sequences);
  chain_.start = Eigen::RowVectorXd::Constant(options.states, kStartCount);
  for (const Rows& posterior : posteriors) chain_.start += posterior.row(0);
  chain_.start /= chain_.start.sum();
  for (int k = 0; k < options.states; ++k) {
    State& state = states_[static_cast<size_t>(k)];
    double weight = 0;
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(prior.size());
    for (size_t i = 0; i < sequences.size(); ++i) {
      weight += posteriors[i].col(k).sum();
      sum += posteriors[i].col(k).transpose() * sequences[i];
    }
    // A state without frames keeps its parameters.
    if (weight > 0) state.mean = sum / weight;
    if (state.mean.size() == 0) state.mean = sum;
    state.covariance = options.prior_weight * prior.asDiagonal().toDenseMatrix();
    for (size_t i = 0; i < sequences.size(); ++i) {
      const Rows centred = sequences[i].rowwise() - state.mean;
      state.covariance += centred.transpose() * posteriors[i].col(k).asDiagonal() * centred;
    }
    state.covariance /= weight + options.prior_weight;
    state.covariance.diagonal().array() += options.least_variance;
  }
}

Rows GaussianHmm::LogDensities(const Rows& known) const {
  const Eigen::Index n = known.cols();
  Rows log_densities(known.rows(), state_count());
  for (int k = 0; k < state_count(); ++k) {
    const State& state = states_[static_cast<size_t>(k)];
    const Eigen::LLT<Eigen::MatrixXd> factor(state.covariance.topLeftCorner(n, n));
    const Eigen::MatrixXd centred = (known.rowwise() - state.mean.head(n)).transpose();
    const Eigen::MatrixXd white = factor.matrixL().solve(centred);
    const double log_root = Eigen::MatrixXd(factor.matrixL()).diagonal().array().log().sum() +
                            0.5 * static_cast<double>(n) * kLogTwoPi;
    log_densities.col(k) = -0.5 * white.colwise().squaredNorm().transpose().array() - log_root;
  }
  return log_densities;
}

double GaussianHmm::LogLikelihood(const Rows& sequence) const {
  return SumOverPaths(chain_, LogDensities(sequence)).log_sum;
}

Rows GaussianHmm::Posterior(const Rows& known) const {
  return SumOverPaths(chain_, LogDensities(known)).states;
}

Rows GaussianHmm::ExpectRest(const Rows& known) const {
  const Rows posterior = Posterior(known);
  const Eigen::Index n = known.cols(), rest = states_[0].mean.size() - n;
  Rows expected = Rows::Zero(known.rows(), rest);
  for (int k = 0; k < state_count(); ++k) {
    const State& state = states_[static_cast<size_t>(k)];
    // mean_b + S_ba S_aa^-1 (a - mean_a), one row a frame.
    const Eigen::LLT<Eigen::MatrixXd> factor(state.covariance.topLeftCorner(n, n));
    const Eigen::MatrixXd gain = factor.solve(state.covariance.topRightCorner(n, rest));
    const Rows conditional =
        ((known.rowwise() - state.mean.head(n)) * gain).rowwise() + state.mean.tail(rest);
    expected += posterior.col(k).asDiagonal() * conditional;
  }
  return expected;
}

}  // namespace duet::evaluation::baselines
