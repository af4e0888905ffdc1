#ifndef DUET_MODEL_ENGINE_BODY_FIT_H_
#define DUET_MODEL_ENGINE_BODY_FIT_H_

#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// Finds out from captured pairs how large followers are beside their leaders.
class BodyFit {
 public:
  // `skeleton` must outlive the fit.
  explicit BodyFit(const motion::Skeleton& skeleton)
      : skeleton_(skeleton), ratios_(skeleton.bones.size()) {}

  void Add(const motion::Poses& leader, const motion::Poses& follower);

  // For each bone of the skeleton, the median of its length in the follower, as a multiple of the
  // leader's. Empty unless in nine of ten pairs the followers are smaller, or in nine of ten
  // larger, by at least 2 %: otherwise they are as different as any two people.
  std::vector<double> BoneRatios() const;

 private:
  const motion::Skeleton& skeleton_;
  std::vector<std::vector<double>> ratios_;  // of every bone, [pairs]
  std::vector<double> sizes_;                // of every pair: the follower's bones, together
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_BODY_FIT_H_
