#ifndef DUET_MODEL_CLEANUP_CLEAN_UP_H_
#define DUET_MODEL_CLEANUP_CLEAN_UP_H_

#include <optional>
#include <vector>

#include "model/body/limbs.h"
#include "model/body/surface.h"
#include "model/cleanup/capsules.h"
#include "model/cleanup/facing.h"
#include "model/cleanup/floor.h"
#include "model/cleanup/footsteps.h"
#include "model/cleanup/hand_contact.h"
#include "model/cleanup/joint_ranges.h"
#include "model/cleanup/limb_swings.h"
#include "model/cleanup/pins.h"
#include "model/cleanup/raised_limbs.h"
#include "model/cleanup/shoulders.h"
#include "model/cleanup/spacing.h"
#include "model/cleanup/stance.h"
#include "model/cleanup/strikes.h"
#include "model/cleanup/timing.h"
#include "model/cleanup/upright.h"
#include "model/cleanup/waist.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// Corrects motion that a body cannot perform: keeps it upright, on the floor and near the other
// body, stops sliding feet, limits joint angles, and resolves overlaps. World metres, y up.
namespace duet::cleanup {

struct Options {
  ShoulderOptions shoulders;
  WaistOptions waist;
  UprightOptions upright;
  SpacingOptions spacing;
  FacingOptions facing;
  CapsuleOptions capsules;
  JointRangeOptions joint_ranges;
  FloorOptions floor;
  RaisedLimbOptions raised_limbs;
  StanceOptions stance;
  FootstepOptions footsteps;
  HandContactOptions hand_contact;
  StrikeOptions strikes;
  LimbSwingOptions limb_swings;
  PinOptions pins;
};

// Corrects one window of a follower in stages. Every stage leaves the settled frames unchanged,
// eases in after them, and preserves bone lengths.
//
// Cost:    linear in the frames.
// Threads: const methods are safe to call concurrently.
class CleanUp {
 public:
  // Requires a skeleton that Validate accepts.
  explicit CleanUp(const motion::Skeleton& skeleton, const Options& options = {});

  // The leader's feet define the floor.
  // Shapes: `leader` like the follower; touch, meetings [frames]. At least one frame.
  void Apply(const motion::Poses& leader, const Touch& touch, const Meetings& meetings,
             const Timing& timing, motion::Poses* follower) const;

  // The four parts of Apply, for a caller who looks at the follower or changes it between them: the
  // trunk and how far people are apart; overlaps, arms and joints; limbs that stay up or apart, and
  // feet that stand; hands that meet. All but the first hardly turn the trunk.
  void CorrectTrunk(const motion::Poses& leader, const Timing& timing,
                    motion::Poses* follower) const;
  void CorrectBody(const motion::Poses& leader, const Touch& touch, const Meetings& meetings,
                   const Timing& timing, motion::Poses* follower) const;
  void PlaceFeet(const motion::Poses& leader, const Timing& timing, motion::Poses* follower) const;
  void PlaceHands(const motion::Poses& leader, const Meetings& meetings, const Timing& timing,
                  motion::Poses* follower) const;

  // Turns a follower that looks past its leader back to it (facing.h). Not part of Apply: to be
  // called before CorrectBody, or in a live session once the frames that were sent are joined.
  // Empty limits: does nothing. Shapes: most_away [frames], or empty.
  void FaceLeader(const motion::Poses& leader, const std::vector<float>& most_away,
                  const Timing& timing, motion::Poses* follower) const;

  // The same for a follower with pins, around PlaceFeet and PlaceHands: the body comes to its pins,
  // but not into the leader; then the limbs do, within the ranges of their joints. Pins in settled
  // frames have no effect.
  //
  //   PinnedMotion pinned = clean_up.ApproachPins(leader, touch, pins, timing, &follower);
  //   clean_up.PlaceFeet(leader, timing, &follower);
  //   clean_up.PlaceHands(leader, meetings, timing, &follower);
  //   clean_up.PlacePins(pinned, leader, timing, &follower);
  //
  // The result refers to this object.
  PinnedMotion ApproachPins(const motion::Poses& leader, const Touch& touch,
                            const motion::Pins& pins, const Timing& timing,
                            motion::Poses* follower) const;
  void PlacePins(const PinnedMotion& pinned, const motion::Poses& leader, const Timing& timing,
                 motion::Poses* follower) const;

 private:
  // Absent for a skeleton without feet.
  std::optional<float> Floor(const motion::Poses& leader) const;

  motion::Skeleton skeleton_;
  Options options_;
  body::Body body_;
  std::vector<double> radii_;
  body::Surface surface_;
};

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_CLEAN_UP_H_
