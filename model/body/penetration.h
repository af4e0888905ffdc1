#ifndef DUET_MODEL_BODY_PENETRATION_H_
#define DUET_MODEL_BODY_PENETRATION_H_

#include <vector>

#include "model/motion/body_part.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::body {

// How deeply two bodies overlap. A frame's depth is the largest max(0, r1 + r2 - d) over all pairs
// of a leader's and a follower's bone, with radii r1 and r2 at a distance d. Less is not always
// better, since people touch when they hug: compare it with that of the captured pair.
// Shapes: leader and follower are alike, in world metres.
struct Penetration {
  double frequency = 0;          // share of frames with a depth above 0
  double mean_depth_metres = 0;  // over those frames; 0 without any
  double max_depth_metres = 0;
};
Penetration MeasurePenetration(const motion::Poses& leader, const motion::Poses& follower,
                               const motion::Skeleton& skeleton,
                               const std::vector<motion::BodyPart>& parts);

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_PENETRATION_H_
