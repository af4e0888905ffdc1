#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "model/evaluation/baselines/class_models.h"

namespace duet::evaluation::baselines {
namespace {

class ClassMean : public ClassModel {
 public:
  explicit ClassMean(const std::vector<StandardPair>& pairs) {
    // Each frame has the same weight, as in the metric.
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(pairs[0].follower.cols());
    double frames = 0;
    for (const StandardPair& pair : pairs) {
      sum += pair.follower.colwise().sum();
      frames += static_cast<double>(pair.follower.rows());
    }
    mean_ = sum / frames;
  }

  Rows Predict(const StandardPair& leader) const override {
    return mean_.replicate(leader.leader.rows(), 1);
  }

 private:
  Eigen::RowVectorXd mean_;
};

class NearestNeighbour : public ClassModel {
 public:
  explicit NearestNeighbour(const std::vector<StandardPair>& pairs) : pairs_(pairs) {}

  Rows Predict(const StandardPair& leader) const override {
    const StandardPair* nearest = nullptr;
    double best = std::numeric_limits<double>::infinity();
    for (const StandardPair& pair : pairs_) {
      const double distance = TimeWarpedDistance(leader.leader, pair.leader);
      if (nearest != nullptr && distance >= best) continue;
      best = distance;
      nearest = &pair;
    }
    return StretchTo(nearest->follower, leader.leader.rows());
  }

 private:
  std::vector<StandardPair> pairs_;
};

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

struct GaussianHmmOptions {
  int states = 3;
  int iterations = 15;           // EM iterations
  double prior_weight = 50;      // weight of the pooled diagonal covariance, in samples
  double least_variance = 1e-4;  // added to every variance
};

// A hidden Markov model with Gaussian outputs of full covariance.
//
// Source: Rabiner 1989 (forward-backward, Baum-Welch); regression from a part of the output on the
// rest as in Gaussian mixture regression (Calinon et al. 2010).
// Shapes: sequences of [frames, values]; frames may differ.
class GaussianHmm {
 public:
  GaussianHmm() = default;
  // Initialised by cutting every sequence into `states` equal pieces. Requires at least one
  // sequence of at least one frame.
  GaussianHmm(const std::vector<Rows>& sequences, const GaussianHmmOptions& options);

  int state_count() const { return static_cast<int>(states_.size()); }

  // The probability of each state in each frame, given the first `known.cols()` values of all
  // frames. Shapes: returns [frames, states].
  Rows Posterior(const Rows& known) const;

  // The expected remaining values of each frame, given the first ones of all frames.
  // Shapes: known [frames, n]; returns [frames, values - n].
  Rows ExpectRest(const Rows& known) const;

 private:
  struct State {
    Eigen::RowVectorXd mean;
    Eigen::MatrixXd covariance;
  };

  void Maximise(const std::vector<Rows>& sequences, const std::vector<Rows>& posteriors,
                const GaussianHmmOptions& options);
  // Log densities of rows holding the first values. Shapes: [frames, n] to [frames, states].
  Rows LogDensities(const Rows& known) const;

  std::vector<State> states_;
  ChainWeights chain_;
};

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

constexpr int kLeaderComponents = 4, kFollowerComponents = 8;

class Hmm : public ClassModel {
 public:
  explicit Hmm(const std::vector<StandardPair>& pairs)
      : leader_(StackCues(pairs), kLeaderComponents),
        follower_(StackFollowers(pairs), kFollowerComponents) {
    std::vector<Rows> sequences;
    for (const StandardPair& pair : pairs) {
      Rows both(pair.cues.rows(), leader_.dimensions() + follower_.dimensions());
      both << leader_.Project(pair.cues), follower_.Project(pair.follower);
      sequences.push_back(std::move(both));
    }
    hmm_ = GaussianHmm(sequences, {});
  }

  Rows Predict(const StandardPair& leader) const override {
    return follower_.Reconstruct(hmm_.ExpectRest(leader_.Project(leader.cues)));
  }

 private:
  PoseSpace leader_, follower_;
  GaussianHmm hmm_;
};

}  // namespace

std::unique_ptr<ClassModel> LearnClassMean(const std::vector<StandardPair>& pairs) {
  return std::make_unique<ClassMean>(pairs);
}

std::unique_ptr<ClassModel> LearnNearestNeighbour(const std::vector<StandardPair>& pairs) {
  return std::make_unique<NearestNeighbour>(pairs);
}

std::unique_ptr<ClassModel> LearnHmm(const std::vector<StandardPair>& pairs) {
  return std::make_unique<Hmm>(pairs);
}

}  // namespace duet::evaluation::baselines
