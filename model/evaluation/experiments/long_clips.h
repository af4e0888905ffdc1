#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_LONG_CLIPS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_LONG_CLIPS_H_

#include <string>
#include <vector>

#include "model/evaluation/report/table.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// Figures that show whether a follower keeps its posture and place for minutes. NaN if the skeleton
// lacks the joints.
//
// Units: metres, m/s, degrees; the motion's world is y up.
// Shapes: leader and follower have the same number of frames, at least 2.

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

// Three tables of followers of long leaders, each titled with `what` ("60 s, without a start"): the
// lean by leader and class; all figures by leader, for the worst class; and by class, for the worst
// leader. Rows begin with the model's name.
std::vector<report::Table> LongTables(const std::string& what,
                                      const std::vector<std::string>& classes,
                                      const std::vector<LongClipRow>& rows);

// The distance from its leader that a live follower should keep, metres.
inline constexpr double kNearestWanted = 0.15, kFarthestWanted = 2.75;

// Of a live follower, with the floor at y = 0.
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
LiveHourFigures MeasureLiveHour(const motion::Skeleton& skeleton, const motion::Poses& leader,
                                const motion::Poses& follower, double frame_rate_hz);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_LONG_CLIPS_H_
