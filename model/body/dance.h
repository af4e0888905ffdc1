#ifndef DUET_MODEL_BODY_DANCE_H_
#define DUET_MODEL_BODY_DANCE_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// Figures of a couple that dances for a whole take.
//
// Units: poses in world metres, y up; metres, seconds, degrees. Shapes: leader and follower have
// equal numbers of frames and joints. A figure without events (turns, holds) is NaN.

namespace duet::body {

// The joints that the figures read.
struct DanceJoints {
  int root = 0;
  motion::JointPair hips, feet, wrists;
};
// Wrists are the joints left_wrist and right_wrist, or else left_hand and right_hand. Errors:
// INVALID_ARGUMENT naming the landmark or joint that the skeleton lacks.
absl::StatusOr<DanceJoints> FindDanceJoints(const motion::Skeleton& skeleton);

// A rotation of a person one way, against the line between the two people.
struct Turn {
  double begin = 0, end = 0;  // seconds
  double degrees = 0;         // above 0: clockwise, seen from above
  double middle() const { return (begin + end) / 2; }
};
// The turns of `person`: of at least 230 degrees, faster than 45 degrees a second but for pauses of
// 0.3 s.
std::vector<Turn> FindTurns(const DanceJoints& joints, const motion::Poses& person,
                            const motion::Poses& partner, double frame_rate_hz);

// How turns match captured ones: each captured turn takes the nearest turn the same way, if their
// middles are at most 1.5 s apart.
struct TurnMatch {
  int matched = 0;
  double mean_delay = 0;  // of the middles, absolute
};
TurnMatch MatchTurns(const std::vector<Turn>& captured, const std::vector<Turn>& turns);

// Hands are held where a wrist of one is less than 28 cm from a wrist of the other.
struct Holds {
  double share = 0;         // of the frames
  double mean_seconds = 0;  // of an uninterrupted hold
  double slip = 0;          // m/s, relative speed of the two nearest wrists while held
};
Holds MeasureHolds(const DanceJoints& joints, const motion::Poses& leader,
                   const motion::Poses& follower, double frame_rate_hz);

// The share of frames in which both feet are faster than 0.15 m/s.
double BothFeetMove(const DanceJoints& joints, const motion::Poses& person, double frame_rate_hz);

// The mean distance of each joint from the captured one.
double MeanError(const motion::Poses& made, const motion::Poses& captured);

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_DANCE_H_
