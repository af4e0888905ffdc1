#include "model/retargeting/mannequin.h"

#include <algorithm>
#include <set>
#include <string>

#include "gtest/gtest.h"
#include "model/retargeting/rig_fitting.h"
#include "tests/support/test_motion.h"

namespace duet::retargeting {
namespace {

class MannequinTest : public ::testing::Test {
 protected:
  const motion::Skeleton skeleton_ = motion::SbuSkeleton();
  const Rig rig_ = MakeRig(skeleton_, test::MakePerson());
  const std::vector<Vec3d> rest_ = RestPositions(rig_);
  const Mannequin mannequin_ = MakeMannequin(skeleton_, rig_, rest_);
};

TEST_F(MannequinTest, TrianglesFaceOutwards) {
  for (const SkinnedMesh* mesh : {&mannequin_.body, &mannequin_.visor}) {
    ASSERT_EQ(mesh->indices.size() % 3, 0u);
    for (std::size_t i = 0; i < mesh->indices.size(); i += 3) {
      const Vec3d a = mesh->positions[mesh->indices[i]], b = mesh->positions[mesh->indices[i + 1]],
                  c = mesh->positions[mesh->indices[i + 2]];
      const Vec3d facing = Cross(b - a, c - a);
      ASSERT_GT(Norm(facing), 1e-9) << "triangle " << i / 3;
      EXPECT_GT(Dot(facing, mesh->normals[mesh->indices[i]]), 0) << "triangle " << i / 3;
    }
  }
}

// Ankles are 2 to 12 cm above the floor, as captures have them.
TEST_F(MannequinTest, SolesAreOnTheFloor) {
  for (double ankle : {0.02, 0.06, 0.12}) {
    const Mannequin mannequin = MakeMannequin(skeleton_, rig_, rest_, ankle);
    double lowest = 1;
    for (std::size_t v = 0; v < mannequin.body.positions.size(); ++v) {
      const std::size_t joint = static_cast<std::size_t>(mannequin.body.joints[v]);
      if (rig_.joints[joint].name != "left_foot") continue;
      lowest = std::min(lowest, mannequin.body.positions[v].y - rest_[joint].y);
    }
    EXPECT_NEAR(lowest, -ankle, 0.011) << ankle;
  }
}

TEST(SoleDepth, IsTheHeightOfAnAnkleThatStandsOnTheFloor) {
  EXPECT_EQ(SoleDepth(0.1), 0.1);
  for (double no_ankle : {-1.0, 0.0, 0.6}) EXPECT_EQ(SoleDepth(no_ankle), kUsualAnkleHeight);
}

// Any skeleton has limbs and balls; only one with a head has a face.
TEST(Mannequin, ASkeletonOfOtherNamesHasABodyWithoutAFace) {
  motion::Skeleton arm;
  arm.joint_names = {"a", "b", "c"};
  arm.bones = {{0, 1}, {1, 2}};
  motion::Clip clip;
  clip.joint_names = arm.joint_names;
  clip.frame_rate_hz = 30;
  clip.Append({{0, 0, 0}, {0, 1, 0}, {0, 2, 0}});
  const Rig rig = MakeRig(arm, clip);
  const Mannequin mannequin = MakeMannequin(arm, rig, RestPositions(rig));
  const std::set<int> fleshed(mannequin.body.joints.begin(), mannequin.body.joints.end());
  EXPECT_EQ(fleshed, (std::set<int>{0, 1, 2}));
  EXPECT_TRUE(mannequin.visor.indices.empty());
}

}  // namespace
}  // namespace duet::retargeting
