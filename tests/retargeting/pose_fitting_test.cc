#include <algorithm>
#include <cmath>
#include <vector>

#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/rig_fitting.h"
#include "tests/support/expect_near.h"
#include "tests/support/test_motion.h"

namespace duet::retargeting {
namespace {

using test::ExpectNear;
using test::MakePerson;
using test::PersonOptions;

constexpr double kRightAngle = 1.5707963267948966;
constexpr Vec3d kUp = {0, 1, 0};
constexpr float kUpperArm = 0.3f, kForearm = 0.25f;
const motion::Vec3 kShoulder = {1, 2, 3};

// Where the joints of the rig are on the skeleton when it is turned so.
std::vector<motion::Vec3> Stand(const Rig& rig, const RigPose& pose, int skeleton_joints) {
  std::vector<motion::Vec3> positions(static_cast<size_t>(skeleton_joints));
  std::vector<Vec3d> at(rig.joints.size());
  std::vector<Quaternion> world(rig.joints.size());
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const RigJoint& joint = rig.joints[j];
    const auto parent = static_cast<std::size_t>(joint.parent);
    const bool root = joint.parent < 0;
    at[j] = root ? pose.root_position : at[parent] + Rotate(world[parent], joint.offset);
    world[j] = root ? pose.rotations[j] : world[parent] * pose.rotations[j];
    positions[static_cast<size_t>(joint.joint)] = ToFloat(at[j]);
  }
  return positions;
}

TEST(PoseFitting, TurnsTheRigIntoThePoseOfEveryFrame) {
  PersonOptions turning;
  turning.yaw = 1;
  turning.turn = 4;
  const motion::Clip clip = MakePerson(turning);
  const Rig rig = MakeRig(motion::SbuSkeleton(), clip);
  PoseFitter fitter(rig, clip.frame_rate_hz);
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    const auto stands = Stand(rig, fitter.Fit(clip.poses[frame]), clip.joint_count());
    for (int joint = 0; joint < clip.joint_count(); ++joint) {
      EXPECT_LT(Distance(stands[static_cast<size_t>(joint)], clip.at(frame, joint)), 1e-3f)
          << "frame " << frame << ", joint " << joint;
    }
  }
}

// An arm alone: shoulder, elbow, hand; straight up in the rest pose.
class Arm : public ::testing::Test {
 protected:
  static motion::Skeleton ArmSkeleton() {
    motion::Skeleton skeleton;
    skeleton.joint_names = {"shoulder", "elbow", "hand"};
    skeleton.bones = {{0, 1}, {1, 2}};
    return skeleton;
  }
  static std::vector<motion::Vec3> Pose(motion::Vec3 upper, motion::Vec3 lower) {
    return {kShoulder, kShoulder + upper, kShoulder + upper + lower};
  }
  static Rig ArmRig() {
    motion::Clip clip;
    clip.joint_names = ArmSkeleton().joint_names;
    clip.frame_rate_hz = 30;
    clip.Append(Pose({0, kUpperArm, 0}, {0, kForearm, 0}));
    return MakeRig(ArmSkeleton(), clip);
  }
  // Fits a frame; both bones' rotations in the world.
  void Fit(motion::Vec3 upper, motion::Vec3 lower) {
    const RigPose& pose = fitter_.Fit(Pose(upper, lower));
    ExpectNear(pose.root_position, ToDouble(kShoulder));
    upper_ = pose.rotations[0];
    lower_ = pose.rotations[0] * pose.rotations[1];
  }

  const Rig rig_ = ArmRig();
  PoseFitter fitter_{rig_, 30};
  Quaternion upper_, lower_;
};

TEST_F(Arm, PointsWhereTheBonesDo) {
  Fit({kUpperArm, 0, 0}, {0, 0, kForearm});
  ExpectNear(Rotate(upper_, kUp), {1, 0, 0});
  ExpectNear(Rotate(lower_, kUp), {0, 0, 1});
}

TEST_F(Arm, TheElbowsPlaneTwistsTheUpperArmWhicheverWayItBends) {
  Fit({kUpperArm, 0, 0}, {0, 0, kForearm});
  ExpectNear(Rotate(upper_, {1, 0, 0}), {0, -1, 0});  // the rest pose's hinge
  Fit({kUpperArm, 0, 0}, {0, 0, -kForearm});
  ExpectNear(Rotate(upper_, {1, 0, 0}), {0, -1, 0});
  ExpectNear(Rotate(lower_, kUp), {0, 0, -1});
}

// Nothing but the last frame and the plain swing say how a straight arm is twisted: five to one
// where the arm is square to its rest pose.
TEST_F(Arm, AStraightArmKeepsMostOfItsTwist) {
  Fit({kUpperArm, 0, 0}, {0, kForearm, 0});
  const Quaternion bent = upper_;
  const Quaternion swing = ShortestArc(kUp, {1, 0, 0}, {1, 0, 0});
  const double twist = Angle(bent, swing);
  Fit({kUpperArm, 0, 0}, {kForearm, 0, 0});
  ExpectNear(Rotate(upper_, kUp), {1, 0, 0});
  const double fades = std::atan2(std::sin(twist), 5 + std::cos(twist));
  EXPECT_NEAR(Angle(upper_, bent), fades, 1e-3);
  EXPECT_NEAR(Angle(upper_, swing), twist - fades, 1e-3);
}

}  // namespace
}  // namespace duet::retargeting
