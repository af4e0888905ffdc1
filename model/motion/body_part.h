#ifndef DUET_MODEL_MOTION_BODY_PART_H_
#define DUET_MODEL_MOTION_BODY_PART_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/motion/skeleton.h"

namespace duet::motion {

// A group of joints that a network encodes together, such as an arm.
struct BodyPart {
  std::string name;
  std::vector<int> joints;  // indices into a skeleton's joint_names
  friend bool operator==(const BodyPart& a, const BodyPart& b) {
    return a.name == b.name && a.joints == b.joints;
  }
};

// Fails with INVALID_ARGUMENT naming the part if there are no parts, a part is empty, or a joint is
// not one of the skeleton's. Parts may share joints, and need not cover all of them.
absl::Status Validate(const std::vector<BodyPart>& parts, const Skeleton& skeleton);

// The parts of SbuSkeleton: left and right arm and leg, and the trunk, of three joints each.
// Source: paper section 3.1.
std::vector<BodyPart> SbuParts();

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_BODY_PART_H_
