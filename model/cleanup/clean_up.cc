#include "model/cleanup/clean_up.h"

#include <optional>

namespace duet::cleanup {

CleanUp::CleanUp(const motion::Skeleton& skeleton, const Options& options)
    : skeleton_(skeleton),
      options_(options),
      body_(body::FindBody(skeleton)),
      radii_(CapsuleRadii(skeleton, body_)),
      surface_(skeleton, body_) {}

void CleanUp::Apply(const motion::Poses& leader, const Touch& touch, const Meetings& meetings,
                    const Timing& timing, motion::Poses* follower) const {
  CorrectTrunk(leader, timing, follower);
  CorrectBody(leader, touch, meetings, timing, follower);
  PlaceFeet(leader, timing, follower);
  PlaceHands(leader, meetings, timing, follower);
}

std::optional<float> CleanUp::Floor(const motion::Poses& leader) const {
  if (!skeleton_.feet) return std::nullopt;
  return FloorHeight(*skeleton_.feet, leader);
}

void CleanUp::CorrectTrunk(const motion::Poses& leader, const Timing& timing,
                           motion::Poses* follower) const {
  // The trunk and the whole body first, then the limbs, so that fixed feet stay fixed.
  if (options_.shoulders.enabled) {
    LimitShoulders(skeleton_, body_, leader, options_.shoulders, timing, follower);
  }
  if (options_.waist.enabled) {
    LimitWaist(skeleton_, body_, leader, options_.waist, timing, follower);
  }
  if (options_.upright.enabled) {
    // Each stage changes the input of the other; after the second pass little remains.
    for (int round = 0; round < 2; ++round) {
      SetTrunkUpright(skeleton_, body_, options_.upright, timing, follower);
      SetUpright(skeleton_, body_, options_.upright, timing, follower);
    }
  }
  if (options_.spacing.enabled) {
    KeepSpacing(skeleton_.root, leader, options_.spacing, timing, follower);
  }
}

void CleanUp::CorrectBody(const motion::Poses& leader, const Touch& touch, const Meetings& meetings,
                          const Timing& timing, motion::Poses* follower) const {
  if (options_.capsules.enabled) {
    PartBodies(skeleton_, body_, radii_, leader, touch, options_.capsules, timing, follower);
  }
  if (options_.hand_contact.enabled) {
    ApproachHand(skeleton_, body_, leader, meetings, options_.hand_contact, timing, follower);
  }
  if (options_.strikes.enabled) {
    ApproachStrikes(skeleton_, body_, surface_, leader, meetings, options_.strikes, timing,
                    follower);
  }
  const std::optional<float> floor = Floor(leader);
  if (floor && options_.floor.enabled) {
    StandOnFloor(skeleton_, *floor, options_.floor, timing, follower);
  }
  if (options_.capsules.enabled) {
    PartArms(skeleton_, body_, radii_, leader, touch, options_.capsules, timing, follower);
  }
  if (options_.joint_ranges.enabled) {
    KeepJointRanges(skeleton_, body_, floor, options_.joint_ranges, timing, follower);
  }
}

void CleanUp::PlaceFeet(const motion::Poses& leader, const Timing& timing,
                        motion::Poses* follower) const {
  // Last, so that standing feet stand and hands meet.
  const std::optional<float> floor = Floor(leader);
  if (options_.raised_limbs.enabled) {
    LowerLimbs(skeleton_, body_, floor, leader, options_.raised_limbs, timing, follower);
  }
  if (options_.stance.enabled) {
    NarrowStance(skeleton_, body_, options_.stance, timing, follower);
  }
  if (floor && options_.footsteps.enabled) {
    WalkInSteps(skeleton_, body_, *floor, options_.footsteps, timing, follower);
  }
}

void CleanUp::PlaceHands(const motion::Poses& leader, const Meetings& meetings,
                         const Timing& timing, motion::Poses* follower) const {
  if (options_.hand_contact.enabled) {
    MeetHand(skeleton_, body_, leader, meetings, options_.hand_contact, timing, follower);
  }
  if (options_.limb_swings.enabled) CalmLimbs(body_, options_.limb_swings, timing, follower);
}

void CleanUp::FaceLeader(const motion::Poses& leader, const std::vector<float>& most_away,
                         const Timing& timing, motion::Poses* follower) const {
  if (!options_.facing.enabled || most_away.empty()) return;
  cleanup::FaceLeader(skeleton_, body_, leader, most_away, options_.facing, timing, follower);
}

PinnedMotion CleanUp::ApproachPins(const motion::Poses& leader, const Touch& touch,
                                   const motion::Pins& pins, const Timing& timing,
                                   motion::Poses* follower) const {
  PinnedMotion pinned(skeleton_, body_, pins, options_.pins, timing, *follower);
  if (pinned.Approach(follower) && options_.capsules.enabled) {
    PartBodies(skeleton_, body_, radii_, leader, touch, options_.capsules, timing, follower);
  }
  pinned.HoldBody(*follower);
  return pinned;
}

void CleanUp::PlacePins(const PinnedMotion& pinned, const motion::Poses& leader,
                        const Timing& timing, motion::Poses* follower) const {
  const KeepRanges keep_ranges = [&](motion::Poses* poses) {
    if (!options_.joint_ranges.enabled) return;
    KeepJointRanges(skeleton_, body_, Floor(leader), options_.joint_ranges, timing, poses);
  };
  pinned.Place(keep_ranges, follower);
}

}  // namespace duet::cleanup
