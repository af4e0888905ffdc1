#ifndef DUET_MODEL_EVALUATION_BASELINES_TAKE_BASELINES_H_
#define DUET_MODEL_EVALUATION_BASELINES_TAKE_BASELINES_H_

#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"

// Followers of whole takes that need no training. The baselines of baselines.h answer clips of a
// few seconds, which they stretch to the length of the leader.

namespace duet::evaluation::baselines {

// For each second of the leader, the follower of the training second whose leader moves most like
// it. Both are compared and placed by the leader's position and direction at their beginning.
// `train` are indices of sequences, some of them at least a second long.
motion::Poses NearestSeconds(const dataset::Dataset& dataset, const std::vector<int>& train,
                             const dataset::Sequence& take);

// In each frame the mean follower of the training frames of the same class, placed by the leader's
// position and direction in that frame. The class of a frame is the first on the time line.
motion::Poses MeanOfClass(const dataset::Dataset& dataset, const std::vector<int>& train,
                          const dataset::Sequence& take);

// The follower's first captured pose in every frame.
motion::Poses FirstPoseHeld(const dataset::Sequence& take);

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_TAKE_BASELINES_H_
