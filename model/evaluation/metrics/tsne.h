#ifndef DUET_MODEL_EVALUATION_METRICS_TSNE_H_
#define DUET_MODEL_EVALUATION_METRICS_TSNE_H_

#include <array>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/metrics/features.h"

namespace duet::evaluation::metrics {

struct TsneOptions {
  double perplexity = 30;  // effective number of neighbours; at most (samples - 1) / 3
  int iterations = 1000;
  double learning_rate = 0;  // 0: samples / 12, at least 50
  double exaggeration = 12;  // of the affinities, during the first 250 iterations
  uint64_t seed = 1;
};

using Point2 = std::array<double, 2>;

// A map of feature vectors to the plane that keeps neighbours together: exact t-SNE.
//
// Source: van der Maaten, Hinton 2008; gains and momentum as there, learning rate after Belkina et
// al. 2019. Each sample's Gaussian is calibrated to the perplexity by bisection. The start is drawn
// from the seed: the same input gives the same map on the same machine.
// Cost:   samples^2 a step; meant for up to a few thousand.
// Errors: INVALID_ARGUMENT for fewer than 4 samples, differing lengths, values that are not finite,
//         a perplexity out of [1, (samples - 1) / 3].
absl::StatusOr<std::vector<Point2>> Tsne(const FeatureSet& features,
                                         const TsneOptions& options = {});

// The share of samples whose nearest neighbour in the plane has the same class: how well a map
// keeps classes together. Shapes: points and classes of the same length, 2 or more.
double NeighbourPurity(const std::vector<Point2>& points, const std::vector<int>& classes);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_TSNE_H_
