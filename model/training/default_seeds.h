#ifndef DUET_MODEL_TRAINING_DEFAULT_SEEDS_H_
#define DUET_MODEL_TRAINING_DEFAULT_SEEDS_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/engine/synthesizer.h"

namespace duet::training {

// Chooses the seeds that a server draws from for callers who name none: of many seeds, those whose
// followers get as far, and come as near their leaders, as captured ones do, in every class. Most
// of what a seed changes is the same for all leaders of a class, so a seed whose followers hardly
// move beside training leaders hardly moves beside others. The best comes first. The result depends
// only on the arguments.
//
// Errors: INTERNAL if an answer is not finite. Requires a generator that samples, and at least one
// sequence in `train`.
absl::StatusOr<std::vector<uint64_t>> ChooseDefaultSeeds(const engine::Synthesizer& synthesizer,
                                                         const dataset::Dataset& dataset,
                                                         const std::vector<int>& train);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_DEFAULT_SEEDS_H_
