#ifndef DUET_MODEL_ENGINE_STRIKE_FIT_H_
#define DUET_MODEL_ENGINE_STRIKE_FIT_H_

#include <optional>
#include <vector>

#include "model/body/limbs.h"
#include "model/body/surface.h"
#include "model/engine/model_description.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// Finds out from captured pairs of one class whether the leader strikes at the follower's body, and
// with which limb: one that reaches out in most stretches of the class and ends near the body.
// World metres.
class StrikeFit {
 public:
  // `skeleton` must outlive the fit.
  explicit StrikeFit(const motion::Skeleton& skeleton);

  // Adds one stretch of the class: frames [begin, end) of a pair.
  void Add(const motion::Poses& leader, const motion::Poses& follower, int begin, int end);

  // The limb; of two, the one that comes nearer. Absent if neither strikes.
  std::optional<StrikingLimb> Limb() const;

 private:
  struct Kind {
    StrikingLimb limb;
    std::vector<body::Limb> body::Body::*limbs;
    double least_reach;
    std::vector<double> nearest;  // of the stretches in which one reaches out
  };

  const motion::Skeleton& skeleton_;
  const body::Body body_;
  const body::Surface surface_;
  std::vector<Kind> kinds_;
  int stretches_ = 0;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_STRIKE_FIT_H_
