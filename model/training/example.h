#ifndef DUET_MODEL_TRAINING_EXAMPLE_H_
#define DUET_MODEL_TRAINING_EXAMPLE_H_

#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"

namespace duet::training {

// The known part of the follower's first frame.
enum class StartKnowledge { kNone, kRoot, kPose };

// One training clip: a sequence, the conditions and the target.
struct Example {
  dataset::Sequence sequence;
  StartKnowledge start = StartKnowledge::kNone;
  std::vector<float> weights;  // [classes], the label vector
  motion::Poses target;        // [frames, joints], world metres
  bool single = true;          // the only label is the sequence's class
};

// A sequence with its own class as label and its captured follower as target.
Example CapturedExample(const dataset::Dataset& dataset, dataset::Sequence sequence,
                        StartKnowledge start);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_EXAMPLE_H_
