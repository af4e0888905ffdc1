#ifndef DUET_MODEL_CLEANUP_STEPS_IN_TIME_H_
#define DUET_MODEL_CLEANUP_STEPS_IN_TIME_H_

#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

// Moves a follower along its own motion, a little ahead or behind, so that its steps fall on those
// of its leader: people who dance together step together, and a network knows where a foot goes
// better than when. A step is moved by at most 0.3 s, to the leader's nearest one; steps that are
// farther from all of the leader's keep their time. Settled frames do not change, and the last
// frame keeps its time.
//
// Poses stay those of the follower's motion or lie between two of them. Requires feet in the
// skeleton. Shapes: follower as leader. Cost: linear in the frames.
void StepInTime(const motion::JointPair& feet, const motion::Poses& leader, const Timing& timing,
                motion::Poses* follower);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_STEPS_IN_TIME_H_
