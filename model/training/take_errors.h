#ifndef DUET_MODEL_TRAINING_TAKE_ERRORS_H_
#define DUET_MODEL_TRAINING_TAKE_ERRORS_H_

#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/checkpoint/manifest.h"
#include "model/dataset/dataset.h"
#include "model/engine/network.h"
#include "model/motion/poses.h"

// Errors of a network in whole takes, in which its windows follow one another.
namespace duet::training {

// The length of a position in a take, seconds.
inline constexpr int kPositionSeconds = 5;

// Number of positions that the longest of `takes` fills.
int PositionCount(absl::Span<const dataset::Sequence> takes, double frame_rate_hz);

// Answers one batch of windows of a network.
using AnswerWindows =
    std::function<std::vector<motion::Poses>(absl::Span<const engine::NetworkInput>)>;

// Mean distance of a joint from the captured one in each position, metres; mean over the takes that
// fill it. The answers are those of variety 0 with the labels of the time lines and the follower's
// first pose, and are not cleaned up. Shapes: returns [PositionCount]. Errors: those of the
// synthesizer; INTERNAL if an answer is not finite.
absl::StatusOr<std::vector<double>> ErrorByPosition(const checkpoint::Manifest& manifest,
                                                    absl::Span<const dataset::Sequence> takes,
                                                    const AnswerWindows& answer);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_TAKE_ERRORS_H_
