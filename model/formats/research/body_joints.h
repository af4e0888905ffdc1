#ifndef DUET_MODEL_FORMATS_RESEARCH_BODY_JOINTS_H_
#define DUET_MODEL_FORMATS_RESEARCH_BODY_JOINTS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::formats::research {

inline constexpr int kBodyJoints = 22;
// The joints' indices.
enum BodyJoint {
  kPelvis,
  kLeftHip,
  kRightHip,
  kSpine1,
  kLeftKnee,
  kRightKnee,
  kSpine2,
  kLeftAnkle,
  kRightAnkle,
  kSpine3,
  kLeftFoot,
  kRightFoot,
  kNeck,
  kLeftCollar,
  kRightCollar,
  kHead,
  kLeftShoulder,
  kRightShoulder,
  kLeftElbow,
  kRightElbow,
  kLeftWrist,
  kRightWrist
};

// The 22 body joints that SMPL, SMPL+H and SMPL-X share, in their order, rooted at the pelvis. A
// foot (left_foot) is the ball of the foot; the ankles are the skeleton's feet.
//
// Source: Loper et al. 2015 (SMPL), Pavlakos et al. 2019 (SMPL-X); HumanML3D, InterGen and Inter-X
// keep the same joints in the same order.
const motion::Skeleton& BodySkeleton();

// The parent of each joint, -1 for the pelvis.
const std::vector<int>& BodyParents();

// The body joints of a person with other joints: those of BodySkeleton() are used unchanged.
// Otherwise joints are taken by their meaning (wrist or hand, ankle or foot, toe), and those that
// the person lacks are placed: pelvis and spine on the way from the hips to the neck, collars
// between neck, spine and shoulder, the head's joint half way from the neck to the head's middle,
// and a missing ball of the foot ahead of the ankle at a right angle to the shin. `placed` receives
// the names of placed joints and may be null.
//
// Units: metres, y up. The rate and the frames stay the same.
// Errors: INVALID_ARGUMENT naming the joints that are missing.
absl::StatusOr<motion::Clip> ToBody(const motion::Clip& person, std::vector<std::string>* placed);

// The joints, toes included, that ToBody takes by their meaning: hips, spine, chest, neck, head and
// both sides' shoulder, elbow, wrist, hip, knee, ankle and toe.
const motion::Skeleton& DetailedSkeleton();

// Whether these are all joints of BodySkeleton(), and perhaps more.
bool HasBodyJoints(const std::vector<std::string>& joint_names);

}  // namespace duet::formats::research

#endif  // DUET_MODEL_FORMATS_RESEARCH_BODY_JOINTS_H_
