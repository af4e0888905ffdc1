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

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_DIRECTION_FIT_H_
