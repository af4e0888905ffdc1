#ifndef DUET_TESTS_TRAINING_TEST_OPTIONS_H_
#define DUET_TESTS_TRAINING_TEST_OPTIONS_H_

#include <variant>

#include "model/checkpoint/manifest.h"
#include "model/dataset/dataset.h"
#include "model/training/options.h"

namespace duet::training {

// Require options of the architecture.
inline PaperTraining& PaperOf(TrainingOptions* options) {
  return std::get<PaperTraining>(options->method);
}
inline FlowTraining& FlowOf(TrainingOptions* options) {
  return std::get<FlowTraining>(options->method);
}

// A network and a run small enough for a test, with every loss and every augmentation on.
inline TrainingOptions SmallOptions() {
  TrainingOptions options;
  PaperOf(&options).discriminator.learning_rate = 1e-3;
  PaperOf(&options).architecture.follower_start = true;
  PaperOf(&options).architecture.base_pose = true;
  PaperOf(&options).architecture.slice_features = 4;
  PaperOf(&options).architecture.encoder_hidden = 4;
  PaperOf(&options).architecture.attention = 8;
  PaperOf(&options).dropout = {0.1, 0.1};
  options.optimiser.weight_decay = 0.01;
  options.optimiser.gradient_clip = 1;
  options.optimiser.average_decay = 0.5;
  options.epochs = 4;
  options.batch = 3;
  options.seed = 5;
  PaperOf(&options).losses.bone = 0.01;
  PaperOf(&options).losses.continuity = 0.1;
  PaperOf(&options).losses.adversarial = 0.1;
  PaperOf(&options).discriminator.hidden = 4;
  options.augmentation.mirror = 0.5;
  options.augmentation.swap_roles = 0.5;
  options.augmentation.body_scale = 0.05;
  options.augmentation.time_warp = 0.1;
  options.augmentation.yaw = 0.1;
  options.augmentation.leader_yaw = 0.1;
  options.augmentation.noise = 0.01;
  options.augmentation.crop = 0.5;
  options.augmentation.body_noise = 0.01;
  PaperOf(&options).graded_labels = 0.5;
  options.start = {0.3, 0.3};
  return options;
}

inline checkpoint::Manifest ManifestFor(const TrainingOptions& options,
                                        const dataset::Dataset& dataset) {
  checkpoint::Manifest manifest;
  manifest.model.name = dataset.name;
  manifest.model.version = 1;
  manifest.model.skeleton = dataset.skeleton;
  manifest.model.classes = dataset.classes;
  manifest.model.frame_rate_hz = dataset.frame_rate_hz;
  manifest.model.window_frames = dataset.LongestFrameCount();
  SetArchitecture(ArchitectureOf(options), &manifest);
  manifest.parts = dataset.parts;
  manifest.standardisation = options.standardisation;
  return manifest;
}

}  // namespace duet::training

#endif  // DUET_TESTS_TRAINING_TEST_OPTIONS_H_
