#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_DIRECTION_ERRORS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_DIRECTION_ERRORS_H_

#include <optional>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/engine/direction_estimate.h"

namespace duet::evaluation::experiments {

// Errors of the partner's estimated direction, degrees, 0 to 180: from a model's regression, or,
// without one, from the leader's hips. Shapes: returns [tests]. Requires a regression for the data
// set's skeleton.
std::vector<double> DirectionErrors(const dataset::Dataset& dataset, const std::vector<int>& tests,
                                    const std::optional<engine::DirectionRegression>& regression);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_DIRECTION_ERRORS_H_
