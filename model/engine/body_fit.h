#ifndef DUET_MODEL_ENGINE_BODY_FIT_H_
#define DUET_MODEL_ENGINE_BODY_FIT_H_

#include <vector>

#include "model/body/limbs.h"
#include "model/body/passing_poses.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// Finds out from captured pairs how large followers are beside their leaders, how upright they
// stand, and for how long they keep poses.
class BodyFit {
 public:
  // `skeleton` must outlive the fit.
  BodyFit(const motion::Skeleton& skeleton, double frame_rate_hz);

  // The postures of pairs of less than ten seconds are ignored: a bow can last as long as they do.
  void Add(const motion::Poses& leader, const motion::Poses& follower);

  // For each bone of the skeleton, the median of its length in the follower, as a multiple of the
  // leader's. Empty unless in nine of ten pairs the followers are smaller, or in nine of ten
  // larger, by at least 2 %: otherwise they are as different as any two people.
  std::vector<double> BoneRatios() const;

  // The hip height (solver::LastingHipHeights) that captured followers exceed nine tenths of the
  // time. 0 for less than half a minute, or without legs.
  double HipHeight() const;

  // The longest time of each pose in a pair that 95 of 100 pairs do not exceed, but at least half a
  // second. 0 for less than half a minute of motion.
  body::PoseSeconds LongestPoses() const;

 private:
  void MeasurePoses(const motion::Poses& leader, const motion::Poses& follower);

  const motion::Skeleton& skeleton_;
  double frame_rate_hz_;
  body::Body body_;
  std::vector<std::vector<double>> ratios_;  // of every bone, [pairs]
  std::vector<double> sizes_;                // of every pair: the follower's bones, together
  std::vector<double> heights_;              // of every frame
  std::vector<double> astride_, held_out_;   // of every pair: the longest time, seconds
  int frames_ = 0;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_BODY_FIT_H_
