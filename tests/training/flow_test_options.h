#ifndef DUET_TESTS_TRAINING_FLOW_TEST_OPTIONS_H_
#define DUET_TESTS_TRAINING_FLOW_TEST_OPTIONS_H_

#include "tests/support/architectures.h"
#include "tests/training/test_options.h"

namespace duet::training {

// A sampling generator and a run small enough for a test.
inline TrainingOptions SmallFlowOptions() {
  TrainingOptions options;
  options.standardisation = motion::StandardOrigin::kFirstFrame;
  checkpoint::FlowArchitecture architecture = test::SmallFlow();
  architecture.width = 16;
  architecture.blocks = 1;
  architecture.feed_forward = 16;
  architecture.reach = 8;
  options.architecture = architecture;
  options.flow = Settings<FlowSettings>(R"(
      flow { passes: 2 least_steps: 0 }
      drift { share: 0 })");
  options.common = Settings<CommonSettings>(R"(
      optimiser { schedule: COSINE second_moment: 0.99 average_decay: 0.9 gradient_clip: 1 }
      epochs: 4
      batch: 3
      seed: 5
      augmentation { mirror: 0.5 noise: 0.01 }
      start { root: 0.1 pose: 0.5 })");
  return options;
}

}  // namespace duet::training

#endif  // DUET_TESTS_TRAINING_FLOW_TEST_OPTIONS_H_
