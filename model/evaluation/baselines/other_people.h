#ifndef DUET_MODEL_EVALUATION_BASELINES_OTHER_PEOPLE_H_
#define DUET_MODEL_EVALUATION_BASELINES_OTHER_PEOPLE_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/motion/poses.h"

namespace duet::evaluation::baselines {

// For each sequence of `test`, returns the captured follower of a random sequence of `train` with
// the same class (`seed`), placed as it stood to its own leader in the first frame. Drawn among
// clips that are at least as long as the leader and cut to its length; if there are none,
// stretched. This is real motion of people who did not see the leader: its figures bound measures
// of similarity between different people. It is not synchronised with the leader.
//
// Shapes: returns [test]. Errors: INVALID_ARGUMENT for a class without a training sequence.
absl::StatusOr<std::vector<motion::Poses>> AnswerWithOtherPeople(const dataset::Dataset& dataset,
                                                                 const std::vector<int>& train,
                                                                 const std::vector<int>& test,
                                                                 uint64_t seed);

// Followers of whole takes that need no training. The baselines of baselines.h answer clips of a
// few seconds, which they stretch to the length of the leader.

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

#endif  // DUET_MODEL_EVALUATION_BASELINES_OTHER_PEOPLE_H_
