#include "model/cleanup/stand_up.h"

#include "gmock/gmock.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using authoring::PuppetPose;

constexpr int kMiddle = kFrames / 2;
constexpr double kLeast = 0.9;

const body::Body& TheBody() {
  static const auto& body = *new body::Body(body::FindBody(motion::SbuSkeleton()));
  return body;
}

// A puppet whose torso is `lower` metres lower than in its standing pose.
motion::Poses Lowered(double lower) {
  return Puppet([lower](double, PuppetPose* pose) { pose->torso.y -= lower; });
}

float Height(const motion::Poses& poses, int frame = kMiddle) {
  return LastingHipHeights(TheBody(), poses, kRate)[static_cast<std::size_t>(frame)];
}

motion::Poses Raised(motion::Poses poses, int settled = 0, double least = kLeast) {
  StandUp(TheBody(), least, {kRate, settled}, &poses);
  return poses;
}

// The farthest that a foot moves.
float FeetMoved(const motion::Poses& a, const motion::Poses& b) {
  float most = 0;
  for (int t = 0; t < a.frame_count(); ++t) {
    for (const body::Limb& leg : TheBody().legs) {
      most = std::max(most, Distance(a.at(t, leg.end), b.at(t, leg.end)));
    }
  }
  return most;
}

TEST(StandUp, RaisesACrouchAboveItsFeet) {
  const motion::Poses crouch = Lowered(0.2);
  ASSERT_LT(Height(crouch), kLeast - 0.1);
  const motion::Poses raised = Raised(crouch);
  EXPECT_NEAR(Height(raised), kLeast, 0.01);
  EXPECT_LT(FeetMoved(crouch, raised), 0.002f);
  EXPECT_LT(LargestLengthChange(crouch, raised), 1e-4f);
}

TEST(StandUp, LeavesThoseWhoStand) {
  const motion::Poses standing = Puppet();
  ASSERT_GT(Height(standing), kLeast);
  EXPECT_EQ(Raised(standing), standing);
  EXPECT_EQ(Raised(Lowered(0.2), 0, 0), Lowered(0.2));
}

TEST(StandUp, LeavesAShortDip) {
  const motion::Poses dip = Puppet([](double seconds, PuppetPose* pose) {
    const double from = (seconds - 1.5) / 0.15;
    pose->torso.y -= 0.15 * std::exp(-from * from);
  });
  EXPECT_LT(LargestDistance(Raised(dip), dip), 0.02f);
}

TEST(StandUp, SettledFramesStayAndTheRestFollowsSmoothly) {
  const motion::Poses crouch = Lowered(0.2), raised = Raised(crouch, 10);
  for (int t = 0; t < 10; ++t) EXPECT_EQ(Distance(raised.at(t, 0), crouch.at(t, 0)), 0) << t;
  EXPECT_LT(LargestStep(raised), 0.04f);
  EXPECT_NEAR(Height(raised, 35), kLeast, 0.01);
}

TEST(StandUp, RaisesNobodyFartherThanTheLegsReach) {
  // Feet so far apart that the legs are nearly straight.
  const motion::Poses split = Puppet([](double, PuppetPose* pose) {
    pose->torso.y -= 0.25;
    pose->left_foot.target.x = 0.62;
    pose->right_foot.target.x = -0.62;
  });
  EXPECT_LT(FeetMoved(split, Raised(split, 0, 1)), 0.01f);
}

TEST(StandUp, NeedsLegs) {
  motion::Poses poses = Lowered(0.2);
  StandUp(body::Body(), kLeast, {kRate, 0}, &poses);
  EXPECT_EQ(poses, Lowered(0.2));
  motion::Poses none(0, 15);
  StandUp(TheBody(), kLeast, {kRate, 0}, &none);
  EXPECT_EQ(none.frame_count(), 0);
}

}  // namespace
}  // namespace duet::cleanup
