#include "client/model_skeleton.h"

#include <optional>
#include <string>

#include "absl/strings/str_cat.h"

namespace duet::client {
namespace {

// Returns nullopt if the model lacks one of the two joints.
std::optional<motion::JointPair> FindPair(const motion::Skeleton& skeleton, const std::string& left,
                                          const std::string& right) {
  const motion::JointPair pair{skeleton.Find(left), skeleton.Find(right)};
  if (pair.left < 0 || pair.right < 0) return std::nullopt;
  return pair;
}

}  // namespace

void FindLandmarks(motion::Skeleton* skeleton) {
  skeleton->hips = FindPair(*skeleton, "left_hip", "right_hip");
  skeleton->feet = FindPair(*skeleton, "left_foot", "right_foot");
  if (!skeleton->feet) skeleton->feet = FindPair(*skeleton, "left_ankle", "right_ankle");
}

absl::StatusOr<motion::Skeleton> ToSkeleton(const ModelInfo& model) {
  motion::Skeleton skeleton;
  skeleton.joint_names = model.joint_names;
  skeleton.bones = model.bones;
  skeleton.root = skeleton.Find(model.root_joint);
  FindLandmarks(&skeleton);
  absl::Status status = Validate(skeleton);
  if (status.ok()) return skeleton;
  return absl::InternalError(absl::StrCat("the server's model ", model.name, "@", model.version,
                                          " has no usable skeleton: ", status.message()));
}

}  // namespace duet::client
