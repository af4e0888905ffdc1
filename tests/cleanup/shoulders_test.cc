#include "model/cleanup/shoulders.h"

#include "model/base/angle.h"
#include "model/body/grade.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr int kNeck = 1, kLeftShoulder = 3, kLeftHand = 5, kRightShoulder = 6, kRightHand = 8;
constexpr int kMiddle = 20;

// The puppet with shoulders and arms turned about the neck from frame `first` on.
motion::Poses Turned(Vec3 axis, double degrees, int first = 0) {
  motion::Poses poses = Puppet();
  for (int t = first; t < poses.frame_count(); ++t) {
    const Vec3 neck = poses.at(t, kNeck);
    for (int joint = kLeftShoulder; joint <= kRightHand; ++joint) {
      poses.at(t, joint) =
          neck + RotateAbout(poses.at(t, joint) - neck, axis, degrees * base::kRadiansPerDegree);
    }
  }
  return poses;
}

constexpr Vec3 kForwards = {0, 0, 1}, kUp = {0, 1, 0};

// Both shoulders drawn forwards, almost to a point.
motion::Poses Narrow() {
  motion::Poses poses = Puppet();
  for (int t = 0; t < poses.frame_count(); ++t) {
    for (const int shoulder : {kLeftShoulder, kRightShoulder}) {
      const Vec3 neck = poses.at(t, kNeck);
      const float length = Distance(poses.at(t, shoulder), neck);
      const Vec3 way = {shoulder == kLeftShoulder ? 0.05f : -0.05f, 0, 1};
      const Vec3 moved = neck + way * (length / Norm(way)) - poses.at(t, shoulder);
      for (int joint = shoulder; joint < shoulder + 3; ++joint) poses.at(t, joint) += moved;
    }
  }
  return poses;
}

motion::Poses Limited(motion::Poses poses, int settled = 0,
                      const motion::Skeleton& skeleton = motion::SbuSkeleton()) {
  LimitShoulders(skeleton, body::FindBody(skeleton), Puppet(), {}, {kRate, settled}, &poses);
  return poses;
}

double Tilt(const motion::Poses& poses, int frame = kFrames - 1) {
  return body::ShoulderTiltDegrees(motion::SbuSkeleton(), body::FindBody(motion::SbuSkeleton()),
                                   poses[frame]);
}

float Width(const motion::Poses& poses, int frame = kFrames - 1) {
  return Distance(poses.at(frame, kLeftShoulder), poses.at(frame, kRightShoulder));
}

double LargestTurn(const motion::Poses& poses) {
  double largest = 0;
  for (int t = 1; t < poses.frame_count(); ++t) {
    const auto across = [&](int frame) {
      return poses.at(frame, kLeftShoulder) - poses.at(frame, kRightShoulder);
    };
    const Vec3 before = across(t - 1), now = across(t);
    largest = std::max(largest, double{std::atan2(Norm(Cross(before, now)), Dot(before, now))});
  }
  return largest * base::kDegreesPerRadian;
}

TEST(LimitShoulders, LeavesAPersonAlone) {
  EXPECT_EQ(Limited(Puppet()), Puppet());
  EXPECT_EQ(Limited(Turned(kForwards, 11)), Turned(kForwards, 11));
}

TEST(LimitShoulders, SetsTiltedShouldersAcrossTheTrunk) {
  for (const double degrees : {-80.0, -40.0, 40.0, 70.0}) {
    const motion::Poses tilted = Turned(kForwards, degrees), limited = Limited(tilted);
    EXPECT_NEAR(Tilt(tilted), std::abs(degrees), 1);
    EXPECT_LT(Tilt(limited), 25.1) << degrees;
    EXPECT_LT(LargestLengthChange(limited, tilted), 1e-4f);
    EXPECT_EQ(limited.at(kMiddle, kNeck), tilted.at(kMiddle, kNeck));
  }
}

TEST(LimitShoulders, ArmsMoveWithTheirShoulders) {
  const motion::Poses tilted = Turned(kForwards, 60), limited = Limited(tilted);
  for (const int shoulder : {kLeftShoulder, kRightShoulder}) {
    const auto arm = [&](const motion::Poses& poses) {
      return poses.at(kMiddle, shoulder + 2) - poses.at(kMiddle, shoulder);
    };
    EXPECT_LT(Distance(arm(limited), arm(tilted)), 1e-4f);
  }
}

TEST(LimitShoulders, WidensShouldersThatAreDrawnTogether) {
  const motion::Poses narrow = Narrow(), limited = Limited(narrow);
  EXPECT_LT(Width(narrow), 0.1f * Width(Puppet()));
  EXPECT_GT(Width(limited), 0.8f * Width(Puppet()));
  EXPECT_LT(LargestLengthChange(limited, narrow), 1e-4f);
}

TEST(LimitShoulders, ATurnInOneFrameTakesAsLongAsAPersonNeeds) {
  const motion::Poses turned = Turned(kUp, 150, kMiddle), limited = Limited(turned);
  EXPECT_GT(LargestTurn(turned), 140);
  EXPECT_LT(LargestTurn(limited), 720 / kRate + 1);
  EXPECT_LT(Distance(limited.at(kFrames - 1, kLeftHand), turned.at(kFrames - 1, kLeftHand)), 0.01f);
  EXPECT_LT(Distance(limited.at(0, kLeftHand), turned.at(0, kLeftHand)), 0.01f);
  EXPECT_LT(LargestLengthChange(limited, turned), 1e-4f);
}

TEST(LimitShoulders, SettledFramesDoNotChange) {
  const motion::Poses tilted = Turned(kForwards, 60), limited = Limited(tilted, 10);
  for (int t = 0; t < 10; ++t) EXPECT_EQ(limited[t], tilted[t]);
  EXPECT_LT(Tilt(limited), 25.1);
  EXPECT_GT(Tilt(limited, 10), 50);  // eases in
}

TEST(LimitShoulders, NeedsHipsAndAnArmOnEachSide) {
  EXPECT_EQ(Limited(Turned(kForwards, 60), 0, WithoutHips()), Turned(kForwards, 60));
}

}  // namespace
}  // namespace duet::cleanup
