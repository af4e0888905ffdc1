#ifndef DUET_MODEL_EVALUATION_BASELINES_OTHER_PEOPLE_H_
#define DUET_MODEL_EVALUATION_BASELINES_OTHER_PEOPLE_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/motion/poses.h"

namespace duet::evaluation::baselines {

// What people do who have not seen this leader: to each sequence of `test` the captured follower of
// one of `train` of the same class, drawn by `seed`, where it stood to its own leader in the first
// frame. Cut to the leader's length; drawn among clips that are long enough where there are any,
// else stretched. It is real motion, so that its figures show what measures of likeness are worth
// at best between different people; it cannot be in time with the leader.
//
// Shapes: returns [test]. Errors: INVALID_ARGUMENT for a class without a training sequence.
absl::StatusOr<std::vector<motion::Poses>> AnswerWithOtherPeople(const dataset::Dataset& dataset,
                                                                 const std::vector<int>& train,
                                                                 const std::vector<int>& test,
                                                                 uint64_t seed);

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_OTHER_PEOPLE_H_
