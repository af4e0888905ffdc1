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

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_CHAIN_H_
