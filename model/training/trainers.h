#ifndef DUET_MODEL_TRAINING_TRAINERS_H_
#define DUET_MODEL_TRAINING_TRAINERS_H_

#include <memory>
#include <vector>

#include "model/training/epoch_trainer.h"

namespace duet::training {

// Makes the trainer of options.method. Requires a manifest of the same architecture. `validation`
// may be empty. Options, manifest and data set must outlive the trainer.
std::unique_ptr<EpochTrainer> MakeTrainer(const TrainingOptions& options,
                                          const checkpoint::Manifest& manifest,
                                          const dataset::Dataset& dataset, std::vector<int> train,
                                          std::vector<int> validation);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_TRAINERS_H_
