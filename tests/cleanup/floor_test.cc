#include "model/cleanup/floor.h"

#include "model/authoring/puppet.h"
#include "model/motion/feet.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr float kFloor = static_cast<float>(kAnkle);

motion::Poses OnFloor(motion::Poses poses, int settled = 0) {
  StandOnFloor(motion::SbuSkeleton(), kFloor, {}, {kRate, settled}, &poses);
  return poses;
}

motion::Poses Raised(const std::function<double(double)>& height) {
  return Changed(Puppet(), [&](int t, Vec3 joint) {
    return joint + Vec3{0, static_cast<float>(height(t / kRate)), 0};
  });
}

TEST(FloorHeight, IgnoresJumpsAndStrayFrames) {
  motion::Poses poses = Raised([](double t) { return t > 1 && t < 1.5 ? 0.4 : 0; });
  poses.at(7, 11).y = -3;  // lost by a tracker
  EXPECT_NEAR(FloorHeight(*motion::SbuSkeleton().feet, poses), kFloor, 1e-4f);
}

TEST(StandOnFloor, FloatingAndSunkenBodiesAreMovedToTheFloor) {
  for (const double off : {0.3, 0.06, -0.06, -0.5}) {
    const motion::Poses floating = Raised([&](double) { return off; });
    const motion::Poses standing = OnFloor(floating);
    for (const float height : LowerFoot(*motion::SbuSkeleton().feet, standing)) {
      EXPECT_LT(std::abs(height - kFloor), 0.0351f) << off;
    }
    EXPECT_LT(LargestLengthChange(standing, floating), 1e-5f);
  }
}

TEST(StandOnFloor, ABodyOnTheFloorStays) {
  EXPECT_EQ(OnFloor(Puppet()), Puppet());
  const motion::Poses a_little_high = Raised([](double) { return 0.015; });
  EXPECT_EQ(OnFloor(a_little_high), a_little_high);
}

TEST(StandOnFloor, AJumpStays) {
  const auto hop = [](double seconds) {
    return [=](double t) {
      const double at = (t - 1) / seconds;
      return at > 0 && at < 1 ? 0.3 * 4 * at * (1 - at) : 0;
    };
  };
  EXPECT_LT(LargestDistance(OnFloor(Raised(hop(0.2))), Raised(hop(0.2))), 1e-3f);
  // A kick lifts one foot for as long as it likes.
  const motion::Poses on_one_leg =
      Puppet([](double, authoring::PuppetPose* pose) { pose->left_foot.target.y = 0.6; });
  EXPECT_LT(LargestDistance(OnFloor(on_one_leg), on_one_leg), 1e-3f);
  // A jump in the last frames is one too; what stays in the air is not.
  const auto leave = [](double seconds) {
    return [=](double t) { return t > (kFrames - 1) / kRate - seconds ? 0.2 : 0; };
  };
  EXPECT_LT(LargestDistance(OnFloor(Raised(leave(0.1))), Raised(leave(0.1))), 1e-3f);
  EXPECT_LT(OnFloor(Raised(leave(1))).at(kFrames - 1, 11).y, kFloor + 0.0351f);
}

TEST(StandOnFloor, SettledFramesStayAndTheRestFollowsSmoothly) {
  const motion::Poses floating = Raised([](double) { return 0.25; });
  const motion::Poses standing = OnFloor(floating, 12);
  for (int t = 0; t < 12; ++t) EXPECT_EQ(standing[t], floating[t]);
  EXPECT_LT(standing.at(18, 11).y, kFloor + 0.05f);
  EXPECT_LT(LargestStep(standing), 0.08f);
}

TEST(StandOnFloor, NeedsFeet) {
  motion::Poses floating = Raised([](double) { return 0.25; });
  const motion::Poses before = floating;
  StandOnFloor(WithoutFeet(), kFloor, {}, {kRate, 0}, &floating);
  EXPECT_EQ(floating, before);
}

}  // namespace
}  // namespace duet::cleanup
