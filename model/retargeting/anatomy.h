#ifndef DUET_MODEL_RETARGETING_ANATOMY_H_
#define DUET_MODEL_RETARGETING_ANATOMY_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/body_part.h"
#include "model/motion/skeleton.h"

namespace duet::retargeting {

// Which joints of a skeleton are which.
struct Anatomy {
  motion::JointPair hips, feet, shoulders;
  motion::JointPair hands;
  // left_arm, right_arm, left_leg, right_leg and trunk. An arm is all from its shoulder outwards,
  // a leg all from its hip; the trunk is the rest, collar bones with it.
  std::vector<motion::BodyPart> parts;
  // What was found, for people to read: "left_hip, right_hip: LeftUpLeg, RightUpLeg".
  std::vector<std::string> notes;
};

// Finds it from the joints' names (the table of docs/formats.md) and the tree of bones. Hips and
// feet that the skeleton has already are taken as they are. A hand without a name is its arm's
// outermost joint. Requires a skeleton that Validate accepts.
// Errors: INVALID_ARGUMENT naming what no joint stands for, and the names that there are.
absl::StatusOr<Anatomy> FindAnatomy(const motion::Skeleton& skeleton);

// For each joint the one in its place on the other side of the body, by name; itself where there is
// none.
std::vector<int> CounterpartJoints(const std::vector<std::string>& joint_names);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_ANATOMY_H_
