#ifndef DUET_MODEL_SOLVER_PARTNER_H_
#define DUET_MODEL_SOLVER_PARTNER_H_

#include <array>
#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::solver {

// Axes of a trunk, by hips and shoulders together. World metres.
struct TrunkAxes {
  motion::Vec3 hips;                 // the middle of the hips: the origin
  motion::Vec3 across, up, forward;  // of length 1: to the left, to the chest, to the front
  float length = 0;                  // from the hips to the chest

  // Places in the axes, in lengths of the trunk, from and to the world.
  motion::Vec3 PlaceOf(motion::Vec3 joint) const;
  motion::Vec3 WorldOf(motion::Vec3 place) const;
};
// Requires hips, two shoulders and a chest. Shapes: pose [joints].
TrunkAxes TrunkAxesOf(const motion::Skeleton& skeleton, const body::Body& body,
                      absl::Span<const motion::Vec3> pose);

// A hand that rests on the partner's trunk: how much, 0 to 1, and where (TrunkAxes).
struct TrunkHold {
  float weight = 0;
  motion::Vec3 place;
};

// How a class lets two people touch in one frame. Learned from captures; 0 where people do not.
struct ContactRule {
  float overlap = 0;         // how far bodies may overlap, 0 (not at all) to 1 (as in an embrace)
  float hands = 0;           // how much a hand that the leader offers is met, 0 to 1
  float hands_metres = 0;    // the distance of hands that meet
  float away_degrees = 180;  // how far the follower may be turned away
  std::array<TrunkHold, 2> holds = {};  // by the follower's hands, in the order of body::Body::arms
};
using ContactRules = std::vector<ContactRule>;  // [frames]

// A follower beside its leader. All members outlive its use. The skeleton has hips, two shoulders,
// a chest and two legs. Shapes: rules [frames]. World metres, y up.
struct Encounter {
  const motion::Skeleton& skeleton;
  const body::Body& body;
  const motion::Poses& leader;
  const ContactRules& rules;
  double frame_rate_hz = 0;
  int given = 0;  // the first frames of the follower, which stay as they are
};

// What a follower owes its leader: not to stand in it, not to lose it, to face it. Turns and moves
// the whole follower along the floor. The correction is smooth.
void PlaceBody(const Encounter& encounter, motion::Poses* follower);

// Moves the follower's hands, smoothly: to those that they meet, out of the leader, and around the
// leader in an embrace.
void PlaceHands(const Encounter& encounter, motion::Poses* follower);

// How far the follower is turned away from its leader in each frame: the angle about the vertical
// from where it faces to where its leader is, by the means of both over about half a second.
// Degrees; may exceed 180 for a follower who turns on. Requires hips and two shoulders.
std::vector<double> DegreesAway(const motion::Skeleton& skeleton, const body::Body& body,
                                const motion::Poses& leader, const motion::Poses& follower,
                                double frame_rate_hz);

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_PARTNER_H_
