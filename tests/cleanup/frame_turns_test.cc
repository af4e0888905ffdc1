#include "model/cleanup/frame_turns.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/angle.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr int kShoulder = 6, kElbow = 7, kHand = 8, kHip = 12, kKnee = 13, kFoot = 14;
constexpr double kFrameRate = 30;

const motion::Skeleton kPerson = motion::SbuSkeleton();
const body::Body kBody = body::FindBody(kPerson);

// One frame of a puppet with its right hand in front of it.
motion::Poses Raised() {
  return Puppet(
      [](double, authoring::PuppetPose* pose) {
        pose->right_hand.target = {-0.15, -0.1, 0.35};
      },
      1);
}

// The same for a puppet that crouches, so that its knees are bent.
motion::Poses Crouching() {
  return Puppet([](double, authoring::PuppetPose* pose) { pose->torso = {0, 0.9, 0}; }, 1);
}

motion::Poses Slowed(const motion::Poses& before, motion::Poses pose) {
  SlowFrame(kPerson, kBody, {}, kFrameRate, before[0], pose[0]);
  return pose;
}

double Degrees(Vec3 a, Vec3 b) {
  return base::kDegreesPerRadian * std::atan2(double{Norm(Cross(a, b))}, double{Dot(a, b)});
}

// By how much the bone between two joints turns, degrees per second.
double TurnOf(int from, int to, const motion::Poses& before, const motion::Poses& now) {
  return kFrameRate *
         Degrees(before.at(0, to) - before.at(0, from), now.at(0, to) - now.at(0, from));
}

// The forearm points the other way than in `poses`.
motion::Poses Snapped(motion::Poses poses) {
  poses.at(0, kHand) = poses.at(0, kElbow) * 2 - poses.at(0, kHand);
  return poses;
}

// The knee on the other side of the line from hip to foot.
motion::Poses Flipped(motion::Poses poses) {
  poses.at(0, kKnee) += body::BendOf({kHip, kKnee, kFoot, {}}, poses[0]) * -2;
  return poses;
}

TEST(SlowFrame, AForearmThatSnapsTurnsNoFasterThanItCan) {
  const motion::Poses before = Raised(), snapped = Snapped(before),
                      slowed = Slowed(before, snapped);
  EXPECT_GT(TurnOf(kElbow, kHand, before, snapped), 5000);
  EXPECT_LT(TurnOf(kElbow, kHand, before, slowed), 721);
  EXPECT_GT(TurnOf(kElbow, kHand, before, slowed), 500) << "it follows as fast as it can";
  EXPECT_LT(LargestLengthChange(slowed, snapped), 1e-5f);
}

TEST(SlowFrame, AForearmThatSnappedArrivesInTheNextFrames) {
  motion::Poses now = Raised();
  const motion::Poses snapped = Snapped(now);
  for (int t = 0; t < 20; ++t) now = Slowed(now, snapped);
  EXPECT_LT(Distance(now.at(0, kHand), snapped.at(0, kHand)), 1e-4f);
}

TEST(SlowFrame, AnUpperArmThatIsSlowedDownKeepsTheBendOfItsElbow) {
  const motion::Poses before = Raised();
  motion::Poses swung = before;
  for (const int joint : {kElbow, kHand}) {
    const Vec3 shoulder = before.at(0, kShoulder);
    swung.at(0, joint) = shoulder + RotateY(before.at(0, joint) - shoulder, 1.5f);
  }
  const motion::Poses slowed = Slowed(before, swung);
  EXPECT_GT(TurnOf(kShoulder, kElbow, before, swung), 800);
  EXPECT_LT(TurnOf(kShoulder, kElbow, before, slowed), 551);
  EXPECT_NEAR(Distance(slowed.at(0, kShoulder), slowed.at(0, kHand)),
              Distance(swung.at(0, kShoulder), swung.at(0, kHand)), 1e-4f);
}

TEST(SlowFrame, TheFootOfAKneeThatChangesItsSideStays) {
  const motion::Poses before = Crouching(), flipped = Flipped(before);
  const motion::Poses slowed = Slowed(before, flipped);
  const auto normal = [](const motion::Poses& poses) {
    return Cross(poses.at(0, kKnee) - poses.at(0, kHip), poses.at(0, kFoot) - poses.at(0, kKnee));
  };
  EXPECT_GT(Degrees(normal(before), normal(flipped)), 170);
  EXPECT_LT(Degrees(normal(before), normal(slowed)), 45);
  EXPECT_LT(Distance(slowed.at(0, kFoot), before.at(0, kFoot)), 1e-4f);
  EXPECT_LT(LargestLengthChange(slowed, flipped), 1e-4f);
}

TEST(SlowFrame, ALimbThatTurnsWithItsTrunkIsNotSlowedDown) {
  const motion::Poses before = Raised();
  motion::Poses turned = before;
  // By 11 degrees in a frame: trunk and planes of the limbs turn less than they may.
  for (Vec3& joint : turned[0]) joint = RotateY(joint, 0.2f);
  const motion::Poses slowed = Slowed(before, turned);
  EXPECT_LT(LargestDistance(slowed, turned), 0.01f);
}

// The hips and shoulders of `poses` turned about the vertical by `degrees`; the feet stay.
motion::Poses Swivelled(motion::Poses poses, double degrees) {
  for (const int joint : {3, 4, 5, kShoulder, kElbow, kHand, 9, 10, kHip, kKnee}) {
    poses.at(0, joint) = RotateY(poses.at(0, joint), degrees * base::kRadiansPerDegree);
  }
  return poses;
}

TEST(SlowFrame, ATrunkThatTurnsRoundTurnsNoFasterThanItCan) {
  constexpr int kLeftShoulder = 3, kLeftHip = 9, kLeftFoot = 11;
  const motion::Poses before = Crouching(), turned = Swivelled(before, 75);
  const motion::Poses slowed = Slowed(before, turned);
  EXPECT_GT(TurnOf(kShoulder, kLeftShoulder, before, turned), 2000);
  EXPECT_LT(TurnOf(kShoulder, kLeftShoulder, before, slowed), 460);
  EXPECT_LT(TurnOf(kHip, kLeftHip, before, slowed), 361);
  EXPECT_GT(TurnOf(kHip, kLeftHip, before, slowed), 330) << "it follows as fast as it can";
  EXPECT_LT(LargestLengthChange(slowed, turned), 1e-4f);
  for (const int foot : {kLeftFoot, kFoot}) {
    EXPECT_LT(Distance(slowed.at(0, foot), before.at(0, foot)), 1e-4f);
  }
}

TEST(SlowFrame, ATrunkThatTurnedArrivesInTheNextFrames) {
  motion::Poses now = Crouching();
  const motion::Poses turned = Swivelled(now, 75);
  for (int t = 0; t < 20; ++t) now = Slowed(now, turned);
  EXPECT_LT(Distance(now.at(0, kShoulder), turned.at(0, kShoulder)), 1e-3f);
  EXPECT_LT(Distance(now.at(0, kHip), turned.at(0, kHip)), 1e-3f);
}

TEST(SlowFrame, ShouldersThatAreNotAttachedToTheChestAreLeftAlone) {
  motion::Skeleton skeleton = kPerson;
  for (motion::Bone& bone : skeleton.bones) {
    if (bone.child == kShoulder || bone.child == 3) bone.parent = 2;
  }
  const motion::Poses before = Crouching();
  motion::Poses pose = Swivelled(before, 75);
  const Vec3 shoulder = pose.at(0, kShoulder);
  SlowFrame(skeleton, kBody, {}, kFrameRate, before[0], pose[0]);
  EXPECT_EQ(pose.at(0, kShoulder), shoulder);
}

TEST(SlowFrame, SlowLimbsStayBitForBit) {
  const motion::Poses before = Raised();
  motion::Poses pose = before;
  pose.at(0, kHand) += Vec3{0.02f, 0.02f, 0};
  EXPECT_EQ(Slowed(before, pose), pose);
  EXPECT_EQ(Slowed(before, before), before);
}

TEST(SlowFrame, ALimbWithoutLengthStaysAsItIs) {
  const motion::Poses before = Raised();
  motion::Poses pose = Snapped(before);
  pose.at(0, kHand) = pose.at(0, kElbow);
  EXPECT_EQ(Slowed(before, pose), pose);
}

}  // namespace
}  // namespace duet::cleanup
