#ifndef DUET_MODEL_EVALUATION_BASELINES_GAUSSIAN_HMM_H_
#define DUET_MODEL_EVALUATION_BASELINES_GAUSSIAN_HMM_H_

#include <vector>

#include "model/evaluation/baselines/chain.h"
#include "model/evaluation/baselines/motion_matrix.h"

namespace duet::evaluation::baselines {

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

#endif  // DUET_MODEL_EVALUATION_BASELINES_GAUSSIAN_HMM_H_
