#ifndef DUET_TESTS_TRAINING_FLOW_TEST_OPTIONS_H_
#define DUET_TESTS_TRAINING_FLOW_TEST_OPTIONS_H_

#include "tests/support/architectures.h"
#include "tests/training/test_options.h"

namespace duet::training {

// A sampling generator and a run small enough for a test.
inline TrainingOptions SmallFlowOptions() {
  TrainingOptions options;
  options.standardisation = motion::StandardOrigin::kFirstFrame;
  checkpoint::FlowArchitecture& architecture = options.method.emplace<FlowTraining>().architecture;
  architecture = test::SmallFlow();
  architecture.width = 16;
  architecture.blocks = 1;
  architecture.feed_forward = 16;
  architecture.reach = 8;
  FlowOf(&options).passes = 2;
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

}  // namespace duet::training

#endif  // DUET_TESTS_TRAINING_FLOW_TEST_OPTIONS_H_
