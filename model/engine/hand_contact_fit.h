#ifndef DUET_MODEL_ENGINE_HAND_CONTACT_FIT_H_
#define DUET_MODEL_ENGINE_HAND_CONTACT_FIT_H_

#include <optional>
#include <vector>

#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// Finds out from captured pairs of one class whether people meet a hand that their partner offers,
// and at what distance of the hands. World metres, y up.
class HandContactFit {
 public:
  // `skeleton` must outlive the fit.
  explicit HandContactFit(const motion::Skeleton& skeleton);

  // Adds one stretch of the class: frames [begin, end) of a pair.
  void Add(const motion::Poses& leader, const motion::Poses& follower, int begin, int end);

  // The lower quartile of the distances of hands that meet. Absent if the leaders offer a hand for
  // less than 3 s, if less than three tenths of an offered hand's time is met in the mean of the
  // stretches, or without two named arms.
  std::optional<double> Metres(double frame_rate_hz) const;

 private:
  const motion::Skeleton& skeleton_;
  body::Body body_;
  int offered_ = 0;             // frames in which a hand is offered
  std::vector<double> met_;     // distances of offered hands that the follower's hand meets
  std::vector<double> shares_;  // of the offered frames that are met, in each stretch
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_HAND_CONTACT_FIT_H_
