#ifndef DUET_MODEL_TRAINING_TRAINED_SYNTHESIZER_H_
#define DUET_MODEL_TRAINING_TRAINED_SYNTHESIZER_H_

#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/engine/synthesizer.h"

namespace duet::training {

// A finished generator that samples, with the stages of a server around it. `checkpoint` has to
// outlive it. Errors: tensors that do not fit the manifest.
absl::StatusOr<std::unique_ptr<engine::Synthesizer>> SynthesizerOf(
    const checkpoint::Checkpoint& checkpoint);

// The answers to any number of windows, in order.
std::vector<engine::WindowResult> AnswerAll(const engine::Synthesizer& synthesizer,
                                            const std::vector<engine::SynthesisWindow>& windows);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_TRAINED_SYNTHESIZER_H_
