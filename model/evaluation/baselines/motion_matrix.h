#ifndef DUET_MODEL_EVALUATION_BASELINES_MOTION_MATRIX_H_
#define DUET_MODEL_EVALUATION_BASELINES_MOTION_MATRIX_H_

#include <Eigen/Core>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"
#include "model/motion/standardise.h"

namespace duet::evaluation::baselines {

// One row a frame (or a sample), one column a value.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A captured pair in the frame that every baseline works in, which is the paper's: the leader's
// root at the origin in every frame, one constant yaw; -z towards the partner where the capture's
// setup tells its direction, else where the leader's hips face.
//
// Units: metres.
struct StandardPair {
  Rows leader;    // [frames, 3 joints]
  Rows cues;      // [frames, cues]: see LeaderCues
  Rows follower;  // [frames, 3 joints]
};

// The yaw is taken from the leader and the setup alone, never from the follower.
motion::Standardisation BaselineStandardisation(
    const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
    motion::StandardOrigin origin = motion::StandardOrigin::kEveryFrame);

// The leader's half of a pair; `follower` stays empty and sequence.pair.follower is not read.
StandardPair StandardLeader(const motion::Skeleton& skeleton, const dataset::Sequence& sequence);
StandardPair StandardiseSequence(const motion::Skeleton& skeleton,
                                 const dataset::Sequence& sequence);

// A follower in the standard coordinates of its sequence, back in the world.
// Shapes: follower [frames, 3 joints].
motion::Poses FollowerToWorld(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                              const Rows& follower);

// Shapes: rows [frames, 3 joints].
Rows ToRows(const motion::Poses& poses);
motion::Poses FromRows(const Rows& rows);

// What a method sees of the leader in each frame: the pose, its change over four frames, how far
// the root has moved since the first frame, and the time from 0 to 1 (the leader is known as a
// whole). Each is scaled so that typical changes weigh about the same.
// Shapes: `world` in world metres; returns [frames, 6 joints + 4].
Rows LeaderCues(const motion::Standardisation& frame, const motion::Poses& world);

// Motion stretched or shrunk to another number of frames, linearly. Both at least 1.
Rows StretchTo(const Rows& motion, Eigen::Index frames);

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_MOTION_MATRIX_H_
