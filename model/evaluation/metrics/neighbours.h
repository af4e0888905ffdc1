#ifndef DUET_MODEL_EVALUATION_METRICS_NEIGHBOURS_H_
#define DUET_MODEL_EVALUATION_METRICS_NEIGHBOURS_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/metrics/features.h"

namespace duet::evaluation::metrics {

// The share of samples whose class is the most frequent one among their `neighbours` nearest other
// samples (Euclidean): how far classes lie apart in the space itself, whatever a map of it shows.
// Of classes equally frequent the one with the nearest sample counts.
// Shapes: features [samples][features], classes [samples].
// Errors: INVALID_ARGUMENT for vectors or classes of other lengths, and for fewer than `neighbours`
//         + 1 samples. `neighbours` is 1 or more.
absl::StatusOr<double> NeighbourAccuracy(const FeatureSet& features,
                                         const std::vector<int>& classes, int neighbours);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_NEIGHBOURS_H_
