#ifndef DUET_MODEL_TRAINING_EXAMPLE_H_
#define DUET_MODEL_TRAINING_EXAMPLE_H_

#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"

namespace duet::training {

// What of the follower's first frame a clip is told.
enum class StartKnowledge { kNone, kRoot, kPose };

// One training clip: a sequence, what is asked for and what should be answered.
struct Example {
  dataset::Sequence sequence;
  StartKnowledge start = StartKnowledge::kNone;
  std::vector<float> weights;  // [classes], the label vector
  motion::Poses target;        // [frames, joints], world metres
  bool single = true;          // the label vector is the sequence's class alone
};

// A sequence asked for what was captured.
Example CapturedExample(const dataset::Dataset& dataset, dataset::Sequence sequence,
                        StartKnowledge start);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_EXAMPLE_H_
