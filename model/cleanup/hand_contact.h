#ifndef DUET_MODEL_CLEANUP_HAND_CONTACT_H_
#define DUET_MODEL_CLEANUP_HAND_CONTACT_H_

#include <vector>

#include "model/body/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::cleanup {

struct HandContactOptions {
  bool enabled = true;
  // The reach (body::ReachTowards) from which on the follower answers a hand, and that from which
  // on it meets it.
  double answers_reach = 0.6, meets_reach = 0.8;
  // How far a hand is moved at most, and how far the body for it, metres.
  double farthest_metres = 0.6, farthest_body_metres = 0.6;
  double fastest_metres_per_second = 0.8;  // of the body
  // How long before a hand is offered the follower's body and hand begin to answer it.
  double body_lead_seconds = 0.13, hand_lead_seconds = 0.07;
};

// In each frame, how much the hands are to meet, 0 to 1, and the distance at which they do, metres;
// how much a fist and a foot of the leader are to end near the body, and how near; and how much of
// the way to a hand the body leaves out, metres.
struct Meeting {
  float weight = 0;
  float metres = 0;
  float fist = 0;
  float strike_metres = 0;
  float left_out_metres = 0;
  float foot = 0;
  float foot_metres = 0;
};
using Meetings = std::vector<Meeting>;

// Both functions let a hand of the follower meet a hand that the leader offers, where the labels
// ask for it. One hand of each for the whole window: the leader's that is offered most, and the
// follower's that is nearest to it. They do nothing for a skeleton without two named arms.
// `meetings` has as many frames as the follower.
//
// Moves the body towards the hand where the arm is too short.
void ApproachHand(const motion::Skeleton& skeleton, const body::Body& body,
                  const motion::Poses& leader, const Meetings& meetings,
                  const HandContactOptions& options, const Timing& timing, motion::Poses* follower);
// Moves the hand by rotating its arm, preserving bone lengths.
void MeetHand(const motion::Skeleton& skeleton, const body::Body& body, const motion::Poses& leader,
              const Meetings& meetings, const HandContactOptions& options, const Timing& timing,
              motion::Poses* follower);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_HAND_CONTACT_H_
