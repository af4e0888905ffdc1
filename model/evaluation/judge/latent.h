#ifndef DUET_MODEL_EVALUATION_JUDGE_LATENT_H_
#define DUET_MODEL_EVALUATION_JUDGE_LATENT_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/metrics/judged_scores.h"

namespace duet::evaluation::judge {

// The latent space of the paper's generator, one point per sequence: the concatenated output of the
// encoders h_t averaged over the frames. (h_t itself is one point per frame; the paper's figures
// show sequences but do not say how frames are combined.) Without a follower start. `labelled`:
// with the label vector of the sequence's class, as in the paper; otherwise zeros.
//
// Source: paper section 3.1 and Figures 6, 7.
// Shapes: returns [sequences][slices x 2 x encoder_hidden].
// Errors: INVALID_ARGUMENT for another generator or one with other classes or joints than the
//         data's.
absl::StatusOr<metrics::FeatureSet> LatentFeatures(const checkpoint::Checkpoint& checkpoint,
                                                   const dataset::Dataset& dataset,
                                                   const std::vector<int>& sequences,
                                                   bool labelled);

}  // namespace duet::evaluation::judge

#endif  // DUET_MODEL_EVALUATION_JUDGE_LATENT_H_
