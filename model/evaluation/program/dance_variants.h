#ifndef DUET_MODEL_EVALUATION_PROGRAM_DANCE_VARIANTS_H_
#define DUET_MODEL_EVALUATION_PROGRAM_DANCE_VARIANTS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/evaluation/experiments/answers.h"
#include "model/evaluation/program/experiment.h"

// A dancer's model without one of its parts: what each of them is worth.

namespace duet::evaluation::program {

// A model and how it is asked.
struct DanceVariant {
  std::string name;
  SharedSynthesizer synthesizer;
  experiments::AskedSamples asked;
};

// The model of a checkpoint as it is served, then with one change each: without labels that choose
// turns, without steps in time, without raised hips, without clean-up, with four candidates, and
// with all the noise of its training (if its manifest has flow.noise_share). Nothing is trained.
// Errors: those of MakeTorchSynthesizer.
absl::StatusOr<std::vector<DanceVariant>> DanceVariants(const checkpoint::Checkpoint& checkpoint,
                                                        const experiments::AskedSamples& asked);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_DANCE_VARIANTS_H_
