#include "client/capture/vmc_writer.h"

#include <cstddef>
#include <utility>

#include "client/capture/humanoid.h"
#include "client/capture/osc.h"
#include "model/base/index.h"
#include "model/motion/clip.h"
#include "model/motion/poses.h"
#include "model/retargeting/foot_pose.h"
#include "model/retargeting/rotation.h"

namespace duet::client::capture {
namespace {

using retargeting::Quaternion;
using retargeting::Vec3d;

// A joint of the fitted skeleton, the bone that is sent for it, and the bone of the built-in person
// at whose place it is at rest.
struct FittedJoint {
  const char* joint;
  const char* parent;
  const char* bone;
  const char* rest;
};
constexpr FittedJoint kJoints[] = {
    {"hips", "", "Hips", "Hips"},
    {"spine", "hips", "Spine", "Chest"},
    {"chest", "spine", "Chest", "UpperChest"},
    {"neck", "chest", "Neck", "Neck"},
    {"head", "neck", "Head", "Head"},
    {"left_shoulder", "chest", "LeftUpperArm", "LeftUpperArm"},
    {"left_elbow", "left_shoulder", "LeftLowerArm", "LeftLowerArm"},
    {"left_hand", "left_elbow", "LeftHand", "LeftHand"},
    {"right_shoulder", "chest", "RightUpperArm", "RightUpperArm"},
    {"right_elbow", "right_shoulder", "RightLowerArm", "RightLowerArm"},
    {"right_hand", "right_elbow", "RightHand", "RightHand"},
    {"left_hip", "hips", "LeftUpperLeg", "LeftUpperLeg"},
    {"left_knee", "left_hip", "LeftLowerLeg", "LeftLowerLeg"},
    {"left_foot", "left_knee", "LeftFoot", "LeftFoot"},
    {"right_hip", "hips", "RightUpperLeg", "RightUpperLeg"},
    {"right_knee", "right_hip", "RightLowerLeg", "RightLowerLeg"},
    {"right_foot", "right_knee", "RightFoot", "RightFoot"},
};
constexpr char kTransformTypes[] = "sfffffff";
// The bytes of one bone's message, at most.
constexpr std::size_t kBoneBytes = 96;

using base::Index;

motion::Skeleton FittedSkeleton() {
  motion::Skeleton skeleton;
  for (const FittedJoint& joint : kJoints) {
    const int parent = skeleton.Find(joint.parent);
    const int child = skeleton.joint_count();
    skeleton.joint_names.emplace_back(joint.joint);
    if (parent >= 0) skeleton.bones.push_back({parent, child});
  }
  skeleton.hips = {{skeleton.Find("left_hip"), skeleton.Find("right_hip")}};
  skeleton.feet = {{skeleton.Find("left_foot"), skeleton.Find("right_foot")}};
  return skeleton;
}

// The built-in person in the T pose, so that a rotation does not depend on the pose in which a
// motion begins.
retargeting::Rig FittedRig(const motion::Skeleton& skeleton, double frame_rate_hz) {
  const std::vector<Vec3d> rest = HumanoidRestPositions();
  std::vector<motion::Vec3> pose;
  for (const FittedJoint& joint : kJoints) {
    pose.push_back(ToFloat(rest[Index(FindHumanoidBone(joint.rest))]));
  }
  motion::Clip clip;
  clip.joint_names = skeleton.joint_names;
  clip.frame_rate_hz = frame_rate_hz;
  clip.poses = motion::Poses(skeleton.joint_count(), std::move(pose));
  return retargeting::MakeRig(skeleton, clip);
}

// Adds a transform in Unity's axes: mirrored in x.
void AddTransform(const char* name, Vec3d position, Quaternion rotation, OscBundle* bundle) {
  bundle->Add(absl::string_view(name));
  for (const double value : {-position.x, position.y, position.z}) {
    bundle->Add(static_cast<float>(value));
  }
  for (const double value : {rotation.x, -rotation.y, -rotation.z, rotation.w}) {
    bundle->Add(static_cast<float>(value));
  }
}

}  // namespace

VmcWriter::VmcWriter(std::vector<std::string> joint_names, double frame_rate_hz)
    : names_(std::move(joint_names)),
      skeleton_(FittedSkeleton()),
      rig_(FittedRig(skeleton_, frame_rate_hz)),
      fitter_(skeleton_, rig_, frame_rate_hz, retargeting::kUsualAnkleHeight,
              retargeting::BoneLengths::kCaptured) {
  const auto rig_joint = [this](const char* name) {
    std::size_t joint = 0;
    while (rig_.joints[joint].name != name) ++joint;
    return joint;
  };
  for (const FittedJoint& joint : kJoints) {
    bones_.push_back({joint.bone, rig_joint(joint.joint), skeleton_.Find(joint.parent)});
  }
}

absl::StatusOr<std::vector<std::string>> VmcWriter::Write(absl::Span<const motion::Vec3> positions,
                                                          double seconds) {
  if (!map_.has_value()) {
    const motion::Poses first(static_cast<int>(names_.size()),
                              {positions.begin(), positions.end()});
    absl::StatusOr<retargeting::JointMap> map =
        retargeting::MapJoints("the follower", names_, first, skeleton_);
    if (!map.ok()) return map.status();
    map_ = *std::move(map);
  }
  const retargeting::RigPose& pose = fitter_.Fit(ApplyJointMap(*map_, positions));
  std::vector<Vec3d> at(rig_.joints.size());
  std::vector<Quaternion> turned(rig_.joints.size());
  for (std::size_t j = 0; j < rig_.joints.size(); ++j) {
    const int parent = rig_.joints[j].parent;
    const Quaternion above = parent < 0 ? Quaternion{} : turned[Index(parent)];
    at[j] = (parent < 0 ? Vec3d{} : at[Index(parent)]) + Rotate(above, pose.translations[j]);
    turned[j] = above * pose.rotations[j];
  }
  std::vector<std::string> datagrams;
  OscBundle bundle;
  bundle.Begin("/VMC/Ext/OK", "i");
  bundle.Add(1);
  bundle.Begin("/VMC/Ext/T", "f");
  bundle.Add(static_cast<float>(seconds));
  bundle.Begin("/VMC/Ext/Root/Pos", kTransformTypes);
  AddTransform("root", {}, {}, &bundle);
  for (const SentBone& bone : bones_) {
    if (bundle.size() + kBoneBytes > kMaxBundleBytes) {
      datagrams.push_back(bundle.bytes());
      bundle = OscBundle();
    }
    const Vec3d position = at[bone.rig_joint];
    const Quaternion rotation = turned[bone.rig_joint];
    bundle.Begin("/VMC/Ext/Bone/Pos", kTransformTypes);
    if (bone.parent < 0) {
      AddTransform(bone.name, position, rotation, &bundle);
      continue;
    }
    const std::size_t parent = bones_[Index(bone.parent)].rig_joint;
    const Quaternion back = Inverse(turned[parent]);
    AddTransform(bone.name, Rotate(back, position - at[parent]), back * rotation, &bundle);
  }
  datagrams.push_back(bundle.bytes());
  return datagrams;
}

}  // namespace duet::client::capture
