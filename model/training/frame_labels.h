#ifndef DUET_MODEL_TRAINING_FRAME_LABELS_H_
#define DUET_MODEL_TRAINING_FRAME_LABELS_H_

#include <vector>

#include "model/base/random.h"
#include "model/dataset/dataset.h"
#include "model/training/options.h"

namespace duet::training {

// The label weights of every frame of a sequence, in random variants from which a generator with
// frame_labels learns the meaning of a weight: 1 for a class of the frame, 0 where nothing is said
// of the class, -1 where it is absent and avoided. A sequence without a time line has its class in
// every frame. Returns [frames, classes].
std::vector<float> DrawFrameLabels(const dataset::Sequence& sequence, int classes,
                                   const FlowTraining::FrameLabels& options, base::Random* random);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_FRAME_LABELS_H_
