#ifndef DUET_MODEL_ENGINE_FACING_FIT_H_
#define DUET_MODEL_ENGINE_FACING_FIT_H_

#include <optional>
#include <vector>

#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// Finds out from captured pairs of one class whether followers face their leaders.
class FacingFit {
 public:
  // `skeleton` must outlive the fit.
  FacingFit(const motion::Skeleton& skeleton, double frame_rate_hz);

  // Adds one stretch of the class: frames [begin, end) of a pair.
  void Add(const motion::Poses& leader, const motion::Poses& follower, int begin, int end);

  // How far followers are turned away at most, nine tenths of the time. Absent if that is so far
  // that they do not face their leaders, for less than three seconds, and for a skeleton without
  // hips or two named shoulders.
  std::optional<double> Degrees() const;

 private:
  const motion::Skeleton& skeleton_;
  const double frame_rate_hz_;
  const body::Body body_;
  std::vector<double> away_;  // degrees, of every frame
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_FACING_FIT_H_
