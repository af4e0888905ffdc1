#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_LIVE_HOUR_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_LIVE_HOUR_H_

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::evaluation::experiments {

// The distance from its leader that a live follower should keep, metres.
inline constexpr double kNearestWanted = 0.15, kFarthestWanted = 2.75;

// Whether a live follower keeps its posture and place, with the floor at y = 0. Metres, m/s,
// degrees; NaN if the skeleton lacks the joints.
struct LiveHourFigures {
  double trunk_lean = 0;  // hips to neck, the largest mean over one second
  double nearest = 0;     // the smallest and the largest distance of the two roots along the floor
  double farthest = 0;
  double out_of_range = 0;     // share of frames nearer or farther than wanted, in [0, 1]
  double longest_outside = 0;  // the longest time nearer or farther than wanted, seconds
  double feet = 0;             // the largest distance of the lower foot from the floor
  double first_speed = 0;      // of the joints, over the first minute,
  double last_speed = 0;       // and over the last one, both after the noise filter
};
// Shapes: leader and follower have the same number of frames, at least 2.
LiveHourFigures MeasureLiveHour(const motion::Skeleton& skeleton, const motion::Poses& leader,
                                const motion::Poses& follower, double frame_rate_hz);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_LIVE_HOUR_H_
