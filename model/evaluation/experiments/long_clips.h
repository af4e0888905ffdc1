#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_LONG_CLIPS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_LONG_CLIPS_H_

#include <string>
#include <vector>

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// Figures that show whether a follower keeps its posture and place for minutes. NaN if the skeleton
// lacks the joints.
//
// Units: metres, m/s, degrees; the motion's world is y up.

namespace duet::evaluation::experiments {

struct LongClipFigures {
  double trunk_lean = 0;   // hips to neck, the largest mean over one second
  double body_lean = 0;    // feet to neck, likewise
  double feet_above = 0;   // the largest distance of the lower foot above the floor,
  double feet_below = 0;   // and below it
  double farthest = 0;     // the largest distance of the two roots along the floor
  double first_speed = 0;  // of the joints, over the first ten seconds,
  double last_speed = 0;   // and over the last ten, both after the noise filter
  double last_lean = 0;    // over the last ten seconds, the larger of the two leans' means,
  double last_feet = 0;    // and the mean of how far the lower foot is from the floor
};

// The floor is the median height of the leader's lower foot.
// Shapes: the same number of frames in both, at least 2.
LongClipFigures MeasureLongClip(const motion::Skeleton& skeleton, const motion::Poses& leader,
                                const motion::Poses& follower, double frame_rate_hz);

// The figures of a model's answer to a long leader in one class.
struct LongClipRow {
  std::string model;
  std::string leader;
  int interaction_class = 0;
  LongClipFigures figures;
};

// The worst of each figure: the largest, except for speeds the smallest. Ignores NaN. Requires at
// least one row.
LongClipFigures Worst(const std::vector<LongClipRow>& rows);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_LONG_CLIPS_H_
