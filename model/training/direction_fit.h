#ifndef DUET_MODEL_TRAINING_DIRECTION_FIT_H_
#define DUET_MODEL_TRAINING_DIRECTION_FIT_H_

#include <optional>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/engine/direction_estimate.h"

namespace duet::training {

// Fits a regression of the partner's direction on the leader's motion. The training set is each
// leader as captured and mirrored; in symmetric classes the follower is another leader. The first
// estimate learns every leader also from behind, because a capture may confuse left and right hips.
// Returns nothing if no leader's hips have a direction.
//
// Source: ridge regressions in closed form; the penalties were chosen on SBU with held-out people.
std::optional<engine::DirectionRegression> FitPartnerDirection(const dataset::Dataset& dataset,
                                                               const std::vector<int>& train);

// Errors of the partner's estimated direction, degrees, 0 to 180: from a model's regression, or,
// without one, from the leader's hips. Shapes: returns [tests]. Requires a regression for the data
// set's skeleton.
std::vector<double> DirectionErrors(const dataset::Dataset& dataset, const std::vector<int>& tests,
                                    const std::optional<engine::DirectionRegression>& regression);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_DIRECTION_FIT_H_
