#ifndef DUET_MODEL_RETARGETING_ANATOMY_H_
#define DUET_MODEL_RETARGETING_ANATOMY_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/body_part.h"
#include "model/motion/skeleton.h"

namespace duet::retargeting {

// The anatomical role of a skeleton's joints.
struct Anatomy {
  motion::JointPair hips, feet, shoulders;
  motion::JointPair hands;
  // left_arm, right_arm, left_leg, right_leg and trunk. An arm holds all joints from its shoulder
  // outwards, a leg all joints from its hip. The trunk holds the rest, including collar bones.
  std::vector<motion::BodyPart> parts;
  // One line per decision, for people to read: "left_hip, right_hip: LeftUpLeg, RightUpLeg".
  std::vector<std::string> notes;
};

// Finds the anatomy from the joints' names (the table in docs/formats.md) and the tree of bones.
// Keeps hips and feet that the skeleton already has. If no joint is named as a hand, the hand is
// the outermost joint of the arm. Requires a skeleton that Validate accepts. Errors:
// INVALID_ARGUMENT naming the role that no joint has, and the skeleton's names.
absl::StatusOr<Anatomy> FindAnatomy(const motion::Skeleton& skeleton);

// For each joint, its counterpart on the other side of the body, by name; the joint itself if there
// is none.
std::vector<int> CounterpartJoints(const std::vector<std::string>& joint_names);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_ANATOMY_H_
