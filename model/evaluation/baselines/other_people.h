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

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_OTHER_PEOPLE_H_
