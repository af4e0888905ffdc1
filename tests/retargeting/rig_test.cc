#include <cmath>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/rig_fitting.h"
#include "tests/support/expect_near.h"
#include "tests/support/matchers.h"
#include "tests/support/test_motion.h"

namespace duet::retargeting {
namespace {

using test::MakePerson;
using test::PersonOptions;

using Kind = RigJoint::Kind;

const RigJoint& Find(const Rig& rig, const std::string& name) {
  for (const RigJoint& joint : rig.joints) {
    if (joint.name == name) return joint;
  }
  ADD_FAILURE() << "no joint " << name;
  static const RigJoint none;
  return none;
}

void ExpectNear(Vec3d a, Vec3d b) { test::ExpectNear(a, b, 1e-5); }

double Length(const motion::Clip& clip, int a, int b) {
  return static_cast<double>(Distance(clip.at(0, a), clip.at(0, b)));
}

TEST(Rig, HasTheSkeletonsJointsAndAHelperForEachBoneOfABranch) {
  const Rig rig = MakeRig(motion::SbuSkeleton(), MakePerson());
  std::vector<std::string> names;
  for (const RigJoint& joint : rig.joints) names.push_back(joint.name);
  EXPECT_THAT(names,
              ElementsAre("torso", "torso_to_neck", "neck", "neck_to_head", "head",
                          "neck_to_left_shoulder", "left_shoulder", "left_elbow", "left_hand",
                          "neck_to_right_shoulder", "right_shoulder", "right_elbow", "right_hand",
                          "torso_to_left_hip", "left_hip", "left_knee", "left_foot",
                          "torso_to_right_hip", "right_hip", "right_knee", "right_foot"));
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    EXPECT_LT(rig.joints[j].parent, static_cast<int>(j)) << names[j];
  }
  EXPECT_EQ(rig.joints[0].parent, -1);
  EXPECT_EQ(Find(rig, "left_knee").parent, 14);
}

TEST(Rig, LimbsHangOrReachOutAndTheHeadIsUpright) {
  const Rig rig = MakeRig(motion::SbuSkeleton(), MakePerson());
  const std::pair<const char*, Vec3d> limbs[] = {
      {"left_shoulder", {1, 0, 0}}, {"left_elbow", {1, 0, 0}}, {"right_shoulder", {-1, 0, 0}},
      {"right_elbow", {-1, 0, 0}},  {"left_hip", {0, -1, 0}},  {"left_knee", {0, -1, 0}},
      {"right_hip", {0, -1, 0}}};
  for (const auto& [name, direction] : limbs) {
    EXPECT_EQ(Find(rig, name).kind, Kind::kAim) << name;
    ExpectNear(Find(rig, name).rest_direction, direction);
  }
}

TEST(Rig, BonesHaveTheirMedianLength) {
  motion::Clip clip = MakePerson({5});
  const double forearm = Length(clip, 4, 5);
  clip.at(1, 5) = clip.at(1, 4) + motion::Vec3{3, 0, 0};  // one wild frame
  clip.at(2, 5) = clip.at(2, 4);
  const Rig rig = MakeRig(motion::SbuSkeleton(), clip);
  ExpectNear(Find(rig, "left_hand").offset, {forearm, 0, 0});
  ExpectNear(Find(rig, "left_knee").offset, {0, -Length(clip, 9, 10), 0});
  EXPECT_NEAR(Norm(Find(rig, "head").offset), Length(clip, 1, 0), 1e-5);
}

// The rest pose is the person's own, however it turns and wherever it stands.
TEST(Rig, BranchesKeepTheirMeanShapeAlongTheTrunk) {
  PersonOptions turned;
  turned.yaw = 2;
  turned.turn = 3;
  turned.at = {5, 1, -4};
  const Rig rig = MakeRig(motion::SbuSkeleton(), MakePerson());
  const Rig other = MakeRig(motion::SbuSkeleton(), MakePerson(turned));
  const RigJoint& torso = Find(rig, "torso");
  EXPECT_EQ(torso.kind, Kind::kBranch);
  // Its children, and the neck's, which branches as well.
  EXPECT_THAT(torso.neighbours, ElementsAre(1, 9, 12, 0, 3, 6));
  EXPECT_THAT(Find(rig, "neck").neighbours, ElementsAre(0, 3, 6, 2));
  ASSERT_EQ(torso.rest_shape.size(), 6u);
  EXPECT_GT(torso.rest_shape[1].x, 0.05) << "the left hip is to the left";
  EXPECT_LT(torso.rest_shape[1].y, -0.1) << "and below";
  EXPECT_LT(torso.rest_shape[2].x, -0.05);
  EXPECT_GT(torso.rest_shape[4].x, 0.1) << "the left shoulder";
  for (const char* name : {"torso", "neck"}) {
    const RigJoint &a = Find(rig, name), &b = Find(other, name);
    ASSERT_EQ(a.rest_shape.size(), b.rest_shape.size());
    for (std::size_t k = 0; k < a.rest_shape.size(); ++k) {
      test::ExpectNear(a.rest_shape[k], b.rest_shape[k], 1e-4);
    }
  }
}

}  // namespace
}  // namespace duet::retargeting
