#include "model/cleanup/limb_swings.h"

#include "model/base/angle.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr int kShoulder = 6, kElbow = 7, kHand = 8, kRightKnee = 13, kRightFoot = 14;
constexpr int kMiddle = 20;

// The right hand in front of the body.
motion::Poses Raised() {
  return Puppet([](double, authoring::PuppetPose* pose) {
    pose->right_hand.target = {-0.15, -0.1, 0.35};
  });
}

// The forearm points the other way from the middle on.
motion::Poses Snapping() {
  motion::Poses poses = Raised();
  for (int t = kMiddle; t < kFrames; ++t) {
    poses.at(t, kHand) = poses.at(t, kElbow) * 2 - poses.at(t, kHand);
  }
  return poses;
}

// The elbow is on the other side of the line from shoulder to hand in one frame.
motion::Poses Flipping() {
  motion::Poses poses = Raised();
  const body::Limb arm{kShoulder, kElbow, kHand, {}};
  const Vec3 bend = BendOf(arm, poses[kMiddle]);
  poses.at(kMiddle, kElbow) += bend * -2;
  return poses;
}

motion::Poses Calmed(motion::Poses poses, int settled = 0) {
  CalmLimbs(body::FindBody(motion::SbuSkeleton()), {}, {kRate, settled}, &poses);
  return poses;
}

double FastestForearm(const motion::Poses& poses) {
  double fastest = 0;
  for (int t = 1; t < poses.frame_count(); ++t) {
    const Vec3 before = poses.at(t - 1, kHand) - poses.at(t - 1, kElbow);
    const Vec3 now = poses.at(t, kHand) - poses.at(t, kElbow);
    fastest = std::max(fastest, double{std::atan2(Norm(Cross(before, now)), Dot(before, now))});
  }
  return fastest * base::kDegreesPerRadian * kRate;
}

TEST(CalmLimbs, LeavesCalmLimbsAsTheyAre) {
  EXPECT_EQ(Calmed(Raised()), Raised());
  const motion::Poses waving = Puppet([](double t, authoring::PuppetPose* pose) {
    pose->right_hand.target = {-0.15, -0.1 + 0.2 * std::sin(4 * t), 0.35};
  });
  EXPECT_EQ(Calmed(waving), waving);
}

TEST(CalmLimbs, AForearmThatSnapsTakesItsTime) {
  const motion::Poses calmed = Calmed(Snapping());
  EXPECT_GT(FastestForearm(Snapping()), 2000);
  EXPECT_LT(FastestForearm(calmed), 510);
  EXPECT_LT(LargestLengthChange(calmed, Snapping()), 1e-4f);
  EXPECT_LT(Distance(calmed.at(0, kHand), Snapping().at(0, kHand)), 0.02f);
  EXPECT_LT(Distance(calmed.at(kFrames - 1, kHand), Snapping().at(kFrames - 1, kHand)), 0.02f);
}

TEST(CalmLimbs, AnElbowKeepsItsSideAndTheHandItsPlace) {
  const motion::Poses flipping = Flipping(), calmed = Calmed(flipping);
  const auto elbow_step = [](const motion::Poses& poses) {
    return Distance(poses.at(kMiddle, kElbow), poses.at(kMiddle - 1, kElbow));
  };
  EXPECT_GT(elbow_step(flipping), 0.1f);
  EXPECT_LT(elbow_step(calmed), 0.3f * elbow_step(flipping));
  EXPECT_LT(Distance(calmed.at(kMiddle, kHand), flipping.at(kMiddle, kHand)), 0.01f);
  EXPECT_LT(LargestLengthChange(calmed, flipping), 1e-3f);
}

TEST(CalmLimbs, SettledFramesDoNotChange) {
  const motion::Poses calmed = Calmed(Snapping(), kMiddle);
  for (int t = 0; t < kMiddle; ++t) EXPECT_EQ(calmed[t], Snapping()[t]);
  EXPECT_LT(FastestForearm(calmed), 510);
}

TEST(CalmLimbs, AShinThatSnapsTakesItsTime) {
  motion::Poses poses = Puppet();
  for (int t = kMiddle; t < kFrames; ++t) {
    const Vec3 shin = poses.at(t, kRightFoot) - poses.at(t, kRightKnee);
    poses.at(t, kRightFoot) = poses.at(t, kRightKnee) + Vec3{shin.x, -shin.z, shin.y};
  }
  const auto largest_step = [](const motion::Poses& motion) {
    float largest = 0;
    for (int t = 1; t < kFrames; ++t) {
      largest = std::max(largest, Distance(motion.at(t, kRightFoot), motion.at(t - 1, kRightFoot)));
    }
    return largest;
  };
  const motion::Poses calmed = Calmed(poses);
  EXPECT_GT(largest_step(poses), 0.5f);
  EXPECT_LT(largest_step(calmed), 0.35f);
  EXPECT_LT(Distance(calmed.at(kFrames - 1, kRightFoot), poses.at(kFrames - 1, kRightFoot)), 0.02f);
}

}  // namespace
}  // namespace duet::cleanup
