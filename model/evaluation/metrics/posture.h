#ifndef DUET_MODEL_EVALUATION_METRICS_POSTURE_H_
#define DUET_MODEL_EVALUATION_METRICS_POSTURE_H_

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// Whether a body stands, where, and which way it looks. NaN where a skeleton lacks the joints.
//
// Units: poses in world metres, y up; degrees.

namespace duet::evaluation::metrics {

// What the neck (or else the head) is seen from: the middle of the hips or of the feet.
enum class LeanFrom { kHips, kFeet };

// The angle between the vertical and the line up to the neck.
struct Lean {
  double mean_degrees = 0;
  // Of its means over one second (over all of a shorter motion), the largest: a kick leans the body
  // for an instant, a body that falls over keeps leaning.
  double max_degrees = 0;
};
Lean MeasureLean(const motion::Poses& poses, const motion::Skeleton& skeleton, double frame_rate_hz,
                 LeanFrom from);

// The mean angle between where the follower's hips and shoulders face and where the leader's root
// is, both seen from above. 0 to 180. Shapes: as many frames in both.
double FacingDegrees(const motion::Poses& leader, const motion::Poses& follower,
                     const motion::Skeleton& skeleton);

// The mean distance of the two roots along the floor. Shapes: as many frames in both.
double RootDistance(const motion::Poses& leader, const motion::Poses& follower,
                    const motion::Skeleton& skeleton);

// How far the lower foot gets from a floor at a height. All 0 or more.
struct FloorGap {
  double above = 0;
  double below = 0;
  double mean = 0;  // above or below, over all frames
};
FloorGap MeasureFloorGap(const motion::Poses& poses, const motion::Skeleton& skeleton,
                         double floor);

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_POSTURE_H_
