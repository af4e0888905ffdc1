#ifndef DUET_MODEL_MOTION_SKELETON_H_
#define DUET_MODEL_MOTION_SKELETON_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"

namespace duet::motion {

// Two joints held at a fixed distance, as joint indices.
struct Bone {
  int parent = 0;
  int child = 0;
  friend bool operator==(const Bone& a, const Bone& b) {
    return a.parent == b.parent && a.child == b.child;
  }
};

// A group of joints that the network encodes together (paper section 3.1: arms, legs, trunk).
struct BodyPart {
  std::string name;
  std::vector<int> joints;
};

// Joints, bones and body parts of a character. The bones form a tree rooted at `root`.
struct Skeleton {
  std::vector<std::string> joint_names;
  std::vector<Bone> bones;
  std::vector<BodyPart> parts;
  int root = 0;      // the joint that standardisation subtracts (torso on SBU)
  int left_hip = 0;  // left to right hip gives the facing direction
  int right_hip = 0;
  int left_foot = 0;
  int right_foot = 0;

  int joint_count() const { return static_cast<int>(joint_names.size()); }
  // The index of a joint, or -1.
  int Find(std::string_view joint_name) const;
  // The parent of every joint, -1 for the root.
  std::vector<int> Parents() const;
};

// Fails with INVALID_ARGUMENT naming the field when an index is out of range, a name is empty or
// repeated, a part is empty, or the bones are not a tree over all joints rooted at `root`.
absl::Status Validate(const Skeleton& skeleton);

// Indices into skeleton.bones from the root outwards: every bone comes after the one that ends
// where it begins. Requires a skeleton that Validate accepts.
std::vector<int> BonesFromRoot(const Skeleton& skeleton);

// The 15 joints of SBU Kinect Interaction (and K3HI): head, neck, torso, left_shoulder, left_elbow,
// left_hand, right_shoulder, right_elbow, right_hand, left_hip, left_knee, left_foot, right_hip,
// right_knee, right_foot; five parts of three joints.
//
// Source: paper section 3.4 (bones) and 3.1 (parts). Bones are directed away from the torso.
Skeleton SbuSkeleton();

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_SKELETON_H_
