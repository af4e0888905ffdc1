#ifndef DUET_MODEL_BODY_POSTURE_H_
#define DUET_MODEL_BODY_POSTURE_H_

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// Lean, facing and height of a body. NaN if the skeleton lacks the joints.
//
// Units: poses in world metres, y up; degrees.

namespace duet::body {

// The lower end of the line to the neck (or else to the head): the middle of the hips or of the
// feet.
enum class LeanFrom { kHips, kFeet };

// The angle between the vertical and the line up to the neck.
struct Lean {
  double mean_degrees = 0;
  // The largest mean over one second (over all of a shorter motion): a kick leans the body for an
  // instant, a fall for longer.
  double max_degrees = 0;
};
Lean MeasureLean(const motion::Poses& poses, const motion::Skeleton& skeleton, double frame_rate_hz,
                 LeanFrom from);

// The mean angle between the direction that the follower's hips and shoulders face and the
// direction in which the leader's root is, both seen from above. 0 to 180. Shapes: as many frames
// in both.
double FacingDegrees(const motion::Poses& leader, const motion::Poses& follower,
                     const motion::Skeleton& skeleton);

// The mean distance of the two roots along the floor. Shapes: as many frames in both.
double RootDistance(const motion::Poses& leader, const motion::Poses& follower,
                    const motion::Skeleton& skeleton);

// Distances of the lower foot from the floor. All are at least 0.
struct FloorGap {
  double above = 0;
  double below = 0;
  double mean = 0;  // above or below, over all frames
};
FloorGap MeasureFloorGap(const motion::Poses& poses, const motion::Skeleton& skeleton,
                         double floor);

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_POSTURE_H_
