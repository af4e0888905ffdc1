#ifndef DUET_MODEL_MOTION_SKELETON_H_
#define DUET_MODEL_MOTION_SKELETON_H_

#include <optional>
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

// A joint on the left of the body and its counterpart on the right.
struct JointPair {
  int left = 0;
  int right = 0;
  friend bool operator==(const JointPair& a, const JointPair& b) {
    return a.left == b.left && a.right == b.right;
  }
};

// Anatomy and landmarks of a character. The bones form a tree rooted at `root`.
struct Skeleton {
  std::vector<std::string> joint_names;
  std::vector<Bone> bones;
  int root = 0;  // the joint that standardisation subtracts (torso on SBU)

  // Landmarks; a character may lack them.
  std::optional<JointPair> hips;  // the line from left to right defines the facing direction
  std::optional<JointPair> feet;  // the joints that stand on the floor

  int joint_count() const { return static_cast<int>(joint_names.size()); }
  // The index of a joint, or -1.
  int Find(std::string_view joint_name) const;
  // The parent of every joint, -1 for the root.
  std::vector<int> Parents() const;
};

// The joints left_wrist and right_wrist, or else left_hand and right_hand.
std::optional<JointPair> FindHands(const Skeleton& skeleton);

// Fails with INVALID_ARGUMENT naming the field if an index is out of range, a name is empty or
// repeated, or the bones are not a tree over all joints rooted at `root`.
absl::Status Validate(const Skeleton& skeleton);

// INVALID_ARGUMENT naming `field` unless `joint` is the index of a joint.
absl::Status CheckJoint(std::string_view field, int joint, const Skeleton& skeleton);

// Indices into skeleton.bones in topological order: each bone comes after the bone that ends at its
// parent joint. Requires a skeleton that Validate accepts.
std::vector<int> BonesFromRoot(const Skeleton& skeleton);

// The 15 joints of SBU Kinect Interaction (and K3HI): head, neck, torso, left_shoulder, left_elbow,
// left_hand, right_shoulder, right_elbow, right_hand, left_hip, left_knee, left_foot, right_hip,
// right_knee, right_foot.
//
// Source: paper section 3.4. Bones are directed away from the torso.
Skeleton SbuSkeleton();

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_SKELETON_H_
