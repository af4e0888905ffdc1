#ifndef DUET_MODEL_BODY_TOUCH_H_
#define DUET_MODEL_BODY_TOUCH_H_

#include <vector>

#include "model/motion/body_part.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::body {

// The ends of the limbs: the last joints of bone chains in parts with "arm" or "leg" in their name.
// In an SBU skeleton, hands and feet.
std::vector<int> LimbEnds(const motion::Skeleton& skeleton,
                          const std::vector<motion::BodyPart>& parts);

// The share of frames in which a hand or a foot of the follower touches the leader: is within 5 cm
// of the capsule around one of the leader's bones (CapsuleRadii). NaN without limb ends.
// Shapes: leader and follower are alike, in world metres.
double TouchShare(const motion::Poses& leader, const motion::Poses& follower,
                  const motion::Skeleton& skeleton, const std::vector<motion::BodyPart>& parts);

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_TOUCH_H_
