#ifndef DUET_MODEL_MOTION_STANDARDISE_H_
#define DUET_MODEL_MOTION_STANDARDISE_H_

#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::motion {

// Which way the yaw of the first frame is taken out.
enum class YawDirection {
  kRemove,         // the hips of frame 0 end on the +x axis
  kAsReleasedCode  // the published preprocessing turns the wrong way; for exact comparison only
};

// Whose place is the origin.
enum class StandardOrigin {
  kEveryFrame,  // the leader's root in that same frame (the paper): its path is taken out
  kFirstFrame   // the leader's root in the first frame: what stands still in the world stands still
};

// The yaw that turns a horizontal direction to -z, where a standardised leader faces.
double FacingYaw(Vec3 direction);

// The coordinates in which the network sees a clip: the leader's root at the origin, in every frame
// or in the first one, and one constant yaw, such that the leader's left-to-right hip direction in
// frame 0 lies along +x, so that the leader starts facing -z. A skeleton without hips is not turned
// unless the caller says how.
//
// Source: paper section 4 / released preprocessing. Invertible: the root track and yaw are kept.
class Standardisation {
 public:
  // Fits to the leader. `leader` holds at least one frame.
  Standardisation(const Skeleton& skeleton, const Poses& leader,
                  YawDirection direction = YawDirection::kRemove,
                  StandardOrigin origin = StandardOrigin::kEveryFrame);
  // Takes out a yaw of the caller's choice: the angle about +y, in radians, that Apply turns by.
  Standardisation(const Skeleton& skeleton, const Poses& leader, double yaw,
                  StandardOrigin origin = StandardOrigin::kEveryFrame);

  // World to standard; a follower goes through the same transform as its leader. `first_frame`
  // places a shorter run of frames within the leader's.
  Poses Apply(const Poses& world, int first_frame = 0) const;
  // One point of the first frame.
  Vec3 Apply(Vec3 world) const;
  // Standard to world: the exact inverse of Apply.
  Poses Invert(const Poses& standard, int first_frame = 0) const;

  double yaw() const { return yaw_; }

 private:
  double yaw_;               // radians that Apply turns by, about +y
  std::vector<Vec3> roots_;  // [frames] the origin in the world
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_STANDARDISE_H_
