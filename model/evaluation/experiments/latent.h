#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_LATENT_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_LATENT_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/metrics/judged_scores.h"

namespace duet::evaluation::experiments {

// The label vector that the generator receives.
enum class LatentLabels {
  kOwnClass,  // the label vector of the sequence's class, as in the paper
  kNone       // zeros: only the leader's motion is informative
};

// The generator's latent space, one point per sequence: the concatenated output of the encoders h_t
// averaged over the frames. (h_t itself is one point per frame; the paper's figures show sequences
// but do not say how frames are combined.) Without a follower start.
//
// Source: paper section 3.1 and Figures 6, 7.
// Shapes: returns [sequences][slices x 2 x encoder_hidden].
// Errors: FAILED_PRECONDITION if the model's classes or joints differ from the data's; INTERNAL if
//         the network fails.
absl::StatusOr<metrics::FeatureSet> LatentFeatures(const checkpoint::Checkpoint& checkpoint,
                                                   const dataset::Dataset& dataset,
                                                   const std::vector<int>& sequences,
                                                   LatentLabels labels);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_LATENT_H_
