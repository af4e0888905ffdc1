#ifndef DUET_MODEL_SOLVER_PARTNER_H_
#define DUET_MODEL_SOLVER_PARTNER_H_

#include <array>
#include <vector>

#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::solver {

// How a class lets two people touch in one frame. Learned from captures; 0 where people do not.
struct ContactRule {
  float overlap = 0;         // how far bodies may overlap, 0 (not at all) to 1 (as in an embrace)
  float hands = 0;           // how much a hand that the leader offers is met, 0 to 1
  float hands_metres = 0;    // the distance of hands that meet
  float away_degrees = 180;  // how far the follower may be turned away
};
using ContactRules = std::vector<ContactRule>;  // [frames]

// What a follower owes its leader: not to stand in it, not to lose it, to face it, to meet its
// hand. Corrections are smooth and are 0 in the given frames. World metres, y up.
class Partner {
 public:
  // `skeleton` and `body` outlive this. Requires hips, two shoulders, a chest and two legs.
  Partner(const motion::Skeleton& skeleton, const body::Body& body)
      : skeleton_(skeleton), body_(body) {}

  // Turns and moves the whole follower along the floor. Shapes: rules [frames].
  void PlaceBody(const motion::Poses& leader, const ContactRules& rules, double frame_rate_hz,
                 int given, motion::Poses* follower) const;

  // Moves the follower's hands: to those that they meet, and out of the leader.
  void PlaceHands(const motion::Poses& leader, const ContactRules& rules, double frame_rate_hz,
                  int given, motion::Poses* follower) const;

 private:
  // A hand of the leader that is met, by which hand, and how much in each frame.
  struct Meeting {
    const body::Limb* leader = nullptr;
    const body::Limb* follower = nullptr;
    std::vector<float> weights;
  };
  // One for each hand of the leader that is offered at any time, and more than the other one.
  std::vector<Meeting> FindMeetings(const motion::Poses& leader, const ContactRules& rules,
                                    double frame_rate_hz, const motion::Poses& follower) const;
  // The hand that is nearest to the leader's while that is met.
  const body::Limb* NearestArm(const Meeting& meeting, const motion::Poses& leader,
                               const motion::Poses& follower) const;
  void MoveHands(const std::vector<Meeting>& meetings, const motion::Poses& leader,
                 const ContactRules& rules, double frame_rate_hz, int given,
                 motion::Poses* follower) const;
  // The way of the hand in a frame until it meets the leader's.
  motion::Vec3 WayToMeet(const Meeting& meeting, const motion::Poses& leader, float metres, int t,
                         const motion::Poses& follower) const;
  void FaceLeader(const motion::Poses& leader, const ContactRules& rules, double frame_rate_hz,
                  int given, motion::Poses* follower) const;
  motion::Vec3 WayForHand(const Meeting& meeting, const motion::Poses& leader,
                          const ContactRules& rules, int t, const motion::Poses& follower) const;
  float Overlap(absl::Span<const motion::Vec3> leader, absl::Span<const motion::Vec3> follower,
                float allowed) const;

  const motion::Skeleton& skeleton_;
  const body::Body& body_;
};

// How far the follower is turned away from its leader in each frame: the angle about the vertical
// from where it faces to where its leader is, by the means of both over about half a second.
// Degrees; may exceed 180 for a follower who turns on. Requires hips and two shoulders.
std::vector<double> DegreesAway(const motion::Skeleton& skeleton, const body::Body& body,
                                const motion::Poses& leader, const motion::Poses& follower,
                                double frame_rate_hz);

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_PARTNER_H_
