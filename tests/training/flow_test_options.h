#ifndef DUET_TESTS_TRAINING_FLOW_TEST_OPTIONS_H_
#define DUET_TESTS_TRAINING_FLOW_TEST_OPTIONS_H_

#include "tests/training/test_options.h"

namespace duet::training {

// A sampling generator and a run small enough for a test.
inline TrainingOptions SmallFlowOptions() {
  TrainingOptions options;
  options.standardisation = motion::StandardOrigin::kFirstFrame;
  options.flow.emplace();
  options.flow->generator.width = 16;
  options.flow->generator.blocks = 1;
  options.flow->generator.heads = 2;
  options.flow->generator.feed_forward = 16;
  options.flow->generator.reach = 8;
  options.flow->passes = 2;
  options.optimiser.schedule = "cosine";
  options.optimiser.second_moment = 0.99;
  options.optimiser.average_decay = 0.9;
  options.optimiser.gradient_clip = 1;
  options.epochs = 4;
  options.batch = 3;
  options.seed = 5;
  options.augmentation.mirror = 0.5;
  options.augmentation.noise = 0.01;
  options.start = {0.1, 0.5};
  return options;
}

inline checkpoint::Manifest FlowManifestFor(const TrainingOptions& options,
                                            const dataset::Dataset& dataset) {
  checkpoint::Manifest manifest = ManifestFor(options, dataset);
  manifest.flow = options.flow->generator;
  manifest.model.accepts_follower_start = manifest.model.samples = true;
  return manifest;
}

}  // namespace duet::training

#endif  // DUET_TESTS_TRAINING_FLOW_TEST_OPTIONS_H_
