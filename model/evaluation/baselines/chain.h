#ifndef DUET_MODEL_EVALUATION_BASELINES_CHAIN_H_
#define DUET_MODEL_EVALUATION_BASELINES_CHAIN_H_

#include <vector>

#include "model/evaluation/baselines/motion_matrix.h"

namespace duet::evaluation::baselines {

// Weights of the paths through a chain of states: a path s_0 .. s_{T-1} weighs
//   start(s_0) exp(arrival_0(s_0)) prod_t step(s_{t-1}, s_t) exp(arrival_t(s_t)).
// In a hidden Markov model start and step are probabilities and arrivals log densities of the
// observations. In maximum-entropy control they are exponentials of rewards, and the backward
// messages are exponentials of the soft value function
//   V_t(s) = log sum_s' exp(r(s, s') + arrival_{t+1}(s') + V_{t+1}(s')).
// The recurrences are the same.
struct ChainWeights {
  Eigen::RowVectorXd start;  // [states], >= 0
  Eigen::MatrixXd step;      // [from, to], >= 0
};

// The distribution over paths, proportional to their weights.
struct PathPosterior {
  Rows states;         // [frames, states]: probability of being there
  double log_sum = 0;  // log of the sum of all paths' weights (likelihood, partition function)
};

// Sums over all paths; never underflows. If `steps` is not null, adds the expected number of times
// that each step is taken. Shapes: log_arrivals [frames, states], steps [from, to].
// Source: Rabiner 1989; Ziebart et al. 2008.
PathPosterior SumOverPaths(const ChainWeights& chain, const Rows& log_arrivals,
                           Eigen::MatrixXd* steps = nullptr);

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

  // The log-likelihood of a sequence of complete outputs.
  double LogLikelihood(const Rows& sequence) const;

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

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_CHAIN_H_
