#ifndef DUET_MODEL_EVALUATION_METRICS_NEIGHBOURS_H_
#define DUET_MODEL_EVALUATION_METRICS_NEIGHBOURS_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/metrics/features.h"

namespace duet::evaluation::metrics {

// The share of samples whose class is the most frequent one among their `neighbours` nearest other
// samples (Euclidean): how well the classes are separated in the space itself. Among equally
// frequent classes, the one with the nearest sample wins.
// Shapes: features [samples][features], classes [samples].
// Errors: INVALID_ARGUMENT for vectors or classes of different lengths, and for fewer than
//         `neighbours` + 1 samples. Requires `neighbours` >= 1.
absl::StatusOr<double> NeighbourAccuracy(const FeatureSet& features,
                                         const std::vector<int>& classes, int neighbours);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_NEIGHBOURS_H_
