#ifndef DUET_MODEL_CLEANUP_FACING_H_
#define DUET_MODEL_CLEANUP_FACING_H_

#include <vector>

#include "model/body/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

struct FacingOptions {
  bool enabled = true;
  // Standard deviation of the Gaussian that ignores short turns.
  double sigma_seconds = 0.35;
  // How long a follower may be turned away farther than it may, in proportion less if it is turned
  // away much farther.
  double patience_seconds = 0.8;
  // A follower that turns back does so until it is within this share of what it may be turned away.
  double settled_share = 0.5;
  // The fastest turn, degrees per second, and the time that it takes to become so fast.
  double fastest_degrees = 110, start_seconds = 0.3;
  // The time that the rest of the way takes, so that a turn slows down at its end.
  double stop_seconds = 0.4;
  // Bodies that are nearer than this do not show the direction of the leader.
  double near_metres = 0.25;
};

// Returns how far a body is turned away from the leader, signed, by its hips and shoulders, without
// short turns. Degrees. Empty for a skeleton without hips or two named shoulders.
// Shapes: `leader` like the follower; returns [frames].
std::vector<float> DegreesAway(const motion::Skeleton& skeleton, const body::Body& body,
                               const motion::Poses& leader, const motion::Poses& follower,
                               double sigma_frames);

// Turns a follower that looks past its leader for longer than a moment back towards it, as fast as
// a person. The whole body turns about the vertical line through its root; its feet step in a later
// stage. `most_away`: how far it may be turned away, degrees. Whether it is turning back when the
// settled frames end follows from them. Does nothing for a skeleton without hips or two named
// shoulders. Shapes: `leader` like the follower; most_away [frames].
void FaceLeader(const motion::Skeleton& skeleton, const body::Body& body,
                const motion::Poses& leader, const std::vector<float>& most_away,
                const FacingOptions& options, const Timing& timing, motion::Poses* follower);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_FACING_H_
