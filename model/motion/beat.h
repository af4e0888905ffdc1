#ifndef DUET_MODEL_MOTION_BEAT_H_
#define DUET_MODEL_MOTION_BEAT_H_

#include <vector>

namespace duet::motion {

// The beat of the music that a motion is danced to. Time 0 is the motion's first frame.
struct Beat {
  double per_minute = 0;     // above 0
  double first_seconds = 0;  // the first beat

  double period_seconds() const { return 60 / per_minute; }
  // The time of a position in beats: 0 is the first beat.
  double SecondsAt(double beats) const { return first_seconds + beats * period_seconds(); }
};

// The times of the beats, from the first one to the first at or after `end_seconds`, ascending.
std::vector<double> BeatTimes(const Beat& beat, double end_seconds);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_BEAT_H_
