#ifndef DUET_MODEL_EVALUATION_METRICS_FEATURES_H_
#define DUET_MODEL_EVALUATION_METRICS_FEATURES_H_

#include <vector>

#include "absl/status/statusor.h"

// Distances between sets of feature vectors that a classifier computes of motions.
// Shapes: [samples][features].

namespace duet::evaluation::metrics {

using FeatureSet = std::vector<std::vector<float>>;

// Frechet distance of two Gaussians fitted to the sets (FID when the features are an extractor's):
// |mu1 - mu2|^2 + Tr(S1 + S2 - 2 (S1 S2)^(1/2)), covariances with divisor n - 1.
//
// Source: Heusel et al. 2017; paper section 4. Tr (S1 S2)^(1/2) is computed as the sum of the
// singular values of A1^T A2 with S = A A^T (A: the centred samples over sqrt(n - 1)): their
// squares are the eigenvalues of S1 S2. No square root of a rank-deficient matrix is taken, so sets
// with fewer samples than features give exact values, never complex or negative ones. Errors:
// INVALID_ARGUMENT for fewer than 2 samples, differing lengths, values that are not finite.
absl::StatusOr<double> FrechetDistance(const FeatureSet& a, const FeatureSet& b);

// The mean Euclidean distance over all pairs of different samples. 0 for fewer than 2.
double Diversity(const FeatureSet& features);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_FEATURES_H_
