#include "model/cleanup/limb_swings.h"

#include "model/base/angle.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr int kShoulder = 6, kElbow = 7, kHand = 8, kRightHip = 12, kRightKnee = 13,
              kRightFoot = 14;
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
  // The elbow bends by up to 600 degrees per second while its plane turns.
  EXPECT_LT(FastestForearm(calmed), 650);
}

// The longest way of a joint from a frame to the next, metres.
float LargestStepOf(int joint, const motion::Poses& poses) {
  float largest = 0;
  for (int t = 1; t < poses.frame_count(); ++t) {
    largest = std::max(largest, Distance(poses.at(t, joint), poses.at(t - 1, joint)));
  }
  return largest;
}

TEST(CalmLimbs, AShinThatSnapsTakesItsTime) {
  motion::Poses poses = Puppet();
  for (int t = kMiddle; t < kFrames; ++t) {
    const Vec3 shin = poses.at(t, kRightFoot) - poses.at(t, kRightKnee);
    poses.at(t, kRightFoot) = poses.at(t, kRightKnee) + Vec3{shin.x, -shin.z, shin.y};
  }
  const motion::Poses calmed = Calmed(poses);
  EXPECT_GT(LargestStepOf(kRightFoot, poses), 0.5f);
  EXPECT_LT(LargestStepOf(kRightFoot, calmed), 0.35f);
  EXPECT_LT(Distance(calmed.at(kFrames - 1, kRightFoot), poses.at(kFrames - 1, kRightFoot)), 0.02f);
}

// By how much the plane of a limb turns from a frame to the next at most, degrees.
double FastestPlane(const motion::Poses& poses, int upper, int middle, int end) {
  double fastest = 0;
  Vec3 before;
  for (int t = 0; t < poses.frame_count(); ++t) {
    const Vec3 normal =
        Cross(poses.at(t, middle) - poses.at(t, upper), poses.at(t, end) - poses.at(t, middle));
    if (t > 0) {
      fastest =
          std::max(fastest, double{std::atan2(Norm(Cross(before, normal)), Dot(before, normal))});
    }
    before = normal;
  }
  return fastest * base::kDegreesPerRadian;
}

// A knee that is bent by a right angle, at first to one side and then to the other.
motion::Poses KneeThatChangesSides() {
  motion::Poses poses = Puppet();
  for (int t = 0; t < kFrames; ++t) {
    const Vec3 hip = poses.at(t, kRightHip), side = {t < kMiddle ? 0.28f : -0.28f, -0.28f, 0};
    poses.at(t, kRightKnee) = hip + Vec3{0, -0.4f, 0};
    poses.at(t, kRightFoot) = poses.at(t, kRightKnee) + side;
  }
  return poses;
}

TEST(CalmLimbs, ThePlaneOfAKneeTakesItsTimeToTurn) {
  const motion::Poses snapping = KneeThatChangesSides(), calmed = Calmed(snapping);
  EXPECT_GT(FastestPlane(snapping, kRightHip, kRightKnee, kRightFoot), 170);
  EXPECT_LT(FastestPlane(calmed, kRightHip, kRightKnee, kRightFoot), 40);
  EXPECT_LT(LargestLengthChange(calmed, snapping), 1e-3f);
  EXPECT_LT(Distance(calmed.at(0, kRightFoot), snapping.at(0, kRightFoot)), 0.02f);
  EXPECT_LT(Distance(calmed.at(kFrames - 1, kRightFoot), snapping.at(kFrames - 1, kRightFoot)),
            0.02f);
}

// Thigh and shin are both too fast, but their foot is not.
TEST(CalmLimbs, AFootKeepsItsPlaceWhileItsKneeChangesSides) {
  const body::Limb leg{kRightHip, kRightKnee, kRightFoot, {}};
  motion::Poses poses = Puppet();
  for (int t = 0; t < kFrames; ++t) {
    const Vec3 foot = poses.at(t, kRightHip) + Vec3{0.05f, -0.5f, 0.1f};
    ReachBent(leg, foot, {t < kMiddle ? 0.0f : 1.0f, 0, t < kMiddle ? 1.0f : -0.3f}, poses[t]);
  }
  const motion::Poses calmed = Calmed(poses);
  EXPECT_LT(LargestStepOf(kRightKnee, calmed), 0.6f * LargestStepOf(kRightKnee, poses));
  for (int t = 0; t < kFrames; ++t) {
    EXPECT_LT(Distance(calmed.at(t, kRightFoot), poses.at(t, kRightFoot)), 0.01f) << t;
  }
}

// The direction in which a limb bends is seen only while it is bent.
TEST(CalmLimbs, AStraightLegRemembersItsPlane) {
  motion::Poses poses = KneeThatChangesSides();
  for (int t = kMiddle - 8; t < kMiddle + 8; ++t) {
    poses.at(t, kRightFoot) = poses.at(t, kRightKnee) + Vec3{0, -0.4f, t % 2 ? 0.01f : -0.01f};
  }
  const motion::Poses calmed = Calmed(poses);
  for (int t = kMiddle - 3; t < kMiddle + 3; ++t) {
    EXPECT_LT(Distance(calmed.at(t, kRightFoot), poses.at(t, kRightFoot)), 0.15f) << t;
  }
  EXPECT_LT(FastestForearm(calmed), 510);
}

TEST(CalmLimbs, AFoldedArmOpens) {
  motion::Poses poses = Raised();
  for (int t = kMiddle; t < kMiddle + 5; ++t) {
    poses.at(t, kHand) = Lerp(poses.at(t, kShoulder), poses.at(t, kElbow), 0.05f);
  }
  const motion::Poses calmed = Calmed(poses);
  for (int t = 0; t < kFrames; ++t) {
    const Vec3 inner = calmed.at(t, kElbow) - calmed.at(t, kShoulder);
    const Vec3 outer = calmed.at(t, kHand) - calmed.at(t, kElbow);
    EXPECT_LT(std::atan2(Norm(Cross(inner, outer)), Dot(inner, outer)),
              156 * base::kRadiansPerDegree);
  }
}

// A body that spins takes its arms along: only what they do relative to it is limited.
TEST(CalmLimbs, ASpinningBodyTakesItsArmsAlong) {
  const motion::Poses spinning = Changed(Raised(), [](int t, Vec3 joint) {
    return RotateY(joint, t * 500 * base::kRadiansPerDegree / kRate);
  });
  EXPECT_LT(LargestDistance(Calmed(spinning), spinning), 1e-3f);
}

}  // namespace
}  // namespace duet::cleanup
