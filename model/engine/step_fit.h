#ifndef DUET_MODEL_ENGINE_STEP_FIT_H_
#define DUET_MODEL_ENGINE_STEP_FIT_H_

#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// Finds out from captured pairs whether followers step together with their leaders. Seconds.
class StepFit {
 public:
  // `skeleton` must outlive the fit.
  StepFit(const motion::Skeleton& skeleton, double frame_rate_hz)
      : skeleton_(skeleton), frame_rate_hz_(frame_rate_hz) {}

  // Ignores pairs of less than ten seconds.
  void Add(const motion::Poses& leader, const motion::Poses& follower);

  // Whether the time from a follower's step to the leader's nearest one varies by at most nine
  // tenths of what it does for the same steps of the leader at other times of the pair. False for
  // fewer than 100 steps, or without feet.
  bool InTime() const;

 private:
  const motion::Skeleton& skeleton_;
  double frame_rate_hz_;
  // From each step of a follower to the nearest one of the leader, as captured and by chance.
  std::vector<double> captured_, chance_;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_STEP_FIT_H_
