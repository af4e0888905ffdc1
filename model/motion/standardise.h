#ifndef DUET_MODEL_MOTION_STANDARDISE_H_
#define DUET_MODEL_MOTION_STANDARDISE_H_

#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::motion {

// The direction in which the yaw of the first frame is removed.
enum class YawDirection {
  kRemove,         // the hips of frame 0 end along the +x axis
  kAsReleasedCode  // as in the published preprocessing, which rotates in the wrong direction; only
                   // for exact comparison
};

// The position that becomes the origin.
enum class StandardOrigin {
  kEveryFrame,  // the leader's root in the same frame (the paper): this removes its path
  kFirstFrame   // the leader's root in the first frame: what does not move in the world does not
                // move
};

// The yaw that rotates a horizontal direction to -z, the direction that a standardised leader
// faces.
double FacingYaw(Vec3 direction);

// The coordinates of a clip in the network: the leader's root is the origin, in every frame or in
// the first one, and a constant yaw takes the leader's left-to-right hip direction in frame 0 to
// +x. The leader then faces -z in frame 0. A skeleton without hips is not rotated unless the caller
// specifies the yaw.
//
// Source: paper section 4 / released preprocessing. Keeps the root track and the yaw to be
// invertible.
class Standardisation {
 public:
  // Derives the yaw from the leader. Requires at least one frame.
  Standardisation(const Skeleton& skeleton, const Poses& leader,
                  YawDirection direction = YawDirection::kRemove,
                  StandardOrigin origin = StandardOrigin::kEveryFrame);
  // Uses the caller's yaw: the angle about +y, in radians, by which Apply rotates.
  Standardisation(const Skeleton& skeleton, const Poses& leader, double yaw,
                  StandardOrigin origin = StandardOrigin::kEveryFrame);

  // Converts world to standard coordinates. Use the same object for a leader and its follower.
  // `first_frame` is the leader's frame that corresponds to the first of `world`.
  Poses Apply(const Poses& world, int first_frame = 0) const;
  // Converts one point of the first frame.
  Vec3 Apply(Vec3 world) const;
  // Converts standard to world coordinates: the exact inverse of Apply.
  Poses Invert(const Poses& standard, int first_frame = 0) const;

  double yaw() const { return yaw_; }

 private:
  double yaw_;               // radians about +y by which Apply rotates
  std::vector<Vec3> roots_;  // [frames] the origin in the world
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_STANDARDISE_H_
