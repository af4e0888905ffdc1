#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "model/evaluation/baselines/baselines.h"

namespace duet::evaluation::baselines {
namespace {

// A matching's cost so far and its number of matched rows.
struct Path {
  double cost = std::numeric_limits<double>::infinity();
  int length = 0;
};

const Path& Cheapest(const Path& a, const Path& b, const Path& c) {
  const Path& ab = a.cost <= b.cost ? a : b;
  return ab.cost <= c.cost ? ab : c;
}

// The mean distance of matched rows along the best monotone matching of two motions (dynamic time
// warping: steps in either or both; first and last rows are matched).
double TimeWarpedDistance(const Rows& a, const Rows& b) {
  const size_t width = static_cast<size_t>(b.rows());
  // One row of the table at a time; index 0 stands for "before the first row of b".
  std::vector<Path> previous(width + 1), current(width + 1);
  previous[0].cost = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    current[0] = Path{};
    for (size_t j = 1; j <= width; ++j) {
      const Path& from = Cheapest(previous[j - 1], previous[j], current[j - 1]);
      const double distance = (a.row(i) - b.row(static_cast<Eigen::Index>(j) - 1)).norm();
      current[j] = {from.cost + distance, from.length + 1};
    }
    std::swap(previous, current);
  }
  return previous[width].cost / previous[width].length;
}

constexpr double kLogTwoPi = 1.8378770664093453;
constexpr int kLeaderComponents = 4, kFollowerComponents = 8;
constexpr int kStates = 3;
constexpr int kIterations = 15;          // of EM
constexpr double kPriorWeight = 50;      // weight of the pooled diagonal covariance, in samples
constexpr double kLeastVariance = 1e-4;  // added to every variance
// Pseudo-counts that keep every start and every transition possible.
constexpr double kStartCount = 0.1, kTransitionCount = 0.1;

// Every sequence cut into as many pieces of the same length as there are states.
std::vector<Rows> EvenCut(const std::vector<Rows>& sequences) {
  std::vector<Rows> posteriors;
  for (const Rows& sequence : sequences) {
    Rows posterior = Rows::Zero(sequence.rows(), kStates);
    for (Eigen::Index t = 0; t < sequence.rows(); ++t) {
      posterior(t, t * kStates / sequence.rows()) = 1;
    }
    posteriors.push_back(std::move(posterior));
  }
  return posteriors;
}

// Transition counts of a hard assignment of frames to states.
Eigen::MatrixXd CountJumps(const std::vector<Rows>& posteriors) {
  Eigen::MatrixXd jumps = Eigen::MatrixXd::Zero(kStates, kStates);
  for (const Rows& posterior : posteriors) {
    const Eigen::Index steps = posterior.rows() - 1;
    jumps += posterior.topRows(steps).transpose() * posterior.bottomRows(steps);
  }
  return jumps;
}

Eigen::MatrixXd RowsToProbabilities(const Eigen::MatrixXd& counts) {
  const Eigen::MatrixXd padded = counts.array() + kTransitionCount;
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

// A hidden Markov model of leader and follower together with Gaussian outputs of full covariance.
// The answer is the expected follower given the whole leader.
//
// Source: Rabiner 1989 (forward-backward, Baum-Welch); regression from a part of the output on the
// rest as in Gaussian mixture regression (Calinon et al. 2010).
class Hmm {
 public:
  // Initialised by cutting every sequence into equal pieces.
  explicit Hmm(const std::vector<StandardPair>& pairs)
      : leader_(Stack(pairs, &StandardPair::cues), kLeaderComponents),
        follower_(Stack(pairs, &StandardPair::follower), kFollowerComponents) {
    std::vector<Rows> sequences;
    for (const StandardPair& pair : pairs) {
      Rows both(pair.cues.rows(), leader_.dimensions() + follower_.dimensions());
      both << leader_.Project(pair.cues), follower_.Project(pair.follower);
      sequences.push_back(std::move(both));
    }
    std::vector<Rows> posteriors = EvenCut(sequences);
    Maximise(sequences, posteriors);
    chain_.step = RowsToProbabilities(CountJumps(posteriors));
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      Eigen::MatrixXd jumps = Eigen::MatrixXd::Zero(kStates, kStates);
      for (size_t i = 0; i < sequences.size(); ++i) {
        posteriors[i] = SumOverPaths(chain_, LogDensities(sequences[i]), &jumps).states;
      }
      Maximise(sequences, posteriors);
      chain_.step = RowsToProbabilities(jumps);
    }
  }

  Rows Predict(const StandardPair& leader) const {
    const Rows known = leader_.Project(leader.cues);
    const Rows posterior = SumOverPaths(chain_, LogDensities(known)).states;
    const Eigen::Index n = known.cols(), rest = states_[0].mean.size() - n;
    Rows expected = Rows::Zero(known.rows(), rest);
    for (int k = 0; k < kStates; ++k) {
      const State& state = states_[k];
      // mean_b + S_ba S_aa^-1 (a - mean_a), one row a frame.
      const Eigen::LLT<Eigen::MatrixXd> factor(state.covariance.topLeftCorner(n, n));
      const Eigen::MatrixXd gain = factor.solve(state.covariance.topRightCorner(n, rest));
      const Rows conditional =
          ((known.rowwise() - state.mean.head(n)) * gain).rowwise() + state.mean.tail(rest);
      expected += posterior.col(k).asDiagonal() * conditional;
    }
    return follower_.Reconstruct(expected);
  }

 private:
  struct State {
    Eigen::RowVectorXd mean;
    Eigen::MatrixXd covariance;
  };

  void Maximise(const std::vector<Rows>& sequences, const std::vector<Rows>& posteriors) {
    // A few samples do not determine a full covariance: the pooled diagonal one adds some.
    const Eigen::RowVectorXd prior = PooledVariance(sequences);
    chain_.start = Eigen::RowVectorXd::Constant(kStates, kStartCount);
    for (const Rows& posterior : posteriors) chain_.start += posterior.row(0);
    chain_.start /= chain_.start.sum();
    for (int k = 0; k < kStates; ++k) {
      State& state = states_[k];
      double weight = 0;
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(prior.size());
      for (size_t i = 0; i < sequences.size(); ++i) {
        weight += posteriors[i].col(k).sum();
        sum += posteriors[i].col(k).transpose() * sequences[i];
      }
      // A state without frames keeps its parameters.
      if (weight > 0) state.mean = sum / weight;
      if (state.mean.size() == 0) state.mean = sum;
      state.covariance = kPriorWeight * prior.asDiagonal().toDenseMatrix();
      for (size_t i = 0; i < sequences.size(); ++i) {
        const Rows centred = sequences[i].rowwise() - state.mean;
        state.covariance += centred.transpose() * posteriors[i].col(k).asDiagonal() * centred;
      }
      state.covariance /= weight + kPriorWeight;
      state.covariance.diagonal().array() += kLeastVariance;
    }
  }

  // Log densities of rows holding the first values. Shapes: [frames, n] to [frames, states].
  Rows LogDensities(const Rows& known) const {
    const Eigen::Index n = known.cols();
    Rows log_densities(known.rows(), kStates);
    for (int k = 0; k < kStates; ++k) {
      const State& state = states_[k];
      const Eigen::LLT<Eigen::MatrixXd> factor(state.covariance.topLeftCorner(n, n));
      const Eigen::MatrixXd centred = (known.rowwise() - state.mean.head(n)).transpose();
      const Eigen::MatrixXd white = factor.matrixL().solve(centred);
      const double log_root = Eigen::MatrixXd(factor.matrixL()).diagonal().array().log().sum() +
                              0.5 * static_cast<double>(n) * kLogTwoPi;
      log_densities.col(k) = -0.5 * white.colwise().squaredNorm().transpose().array() - log_root;
    }
    return log_densities;
  }

  PoseSpace leader_, follower_;
  State states_[kStates];
  ChainWeights chain_;
};

}  // namespace

ClassModel LearnClassMean(const std::vector<StandardPair>& pairs) {
  // Each frame has the same weight, as in the metric.
  const Eigen::RowVectorXd mean = Stack(pairs, &StandardPair::follower).colwise().mean();
  return [mean](const StandardPair& leader) -> Rows {
    return mean.replicate(leader.leader.rows(), 1);
  };
}

ClassModel LearnNearestNeighbour(const std::vector<StandardPair>& pairs) {
  return [pairs](const StandardPair& leader) {
    std::vector<double> distances;
    for (const StandardPair& pair : pairs) {
      distances.push_back(TimeWarpedDistance(leader.leader, pair.leader));
    }
    const auto nearest = std::min_element(distances.begin(), distances.end()) - distances.begin();
    return StretchTo(pairs[static_cast<size_t>(nearest)].follower, leader.leader.rows());
  };
}

ClassModel LearnHmm(const std::vector<StandardPair>& pairs) {
  return [model = Hmm(pairs)](const StandardPair& leader) { return model.Predict(leader); };
}

}  // namespace duet::evaluation::baselines
