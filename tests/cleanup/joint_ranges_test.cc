#include "model/cleanup/joint_ranges.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/authoring/puppet.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr int kHead = 0, kNeck = 1;
constexpr int kShoulder = 3, kElbow = 4, kHand = 5;  // the left ones
constexpr int kHip = 9, kKnee = 10, kFoot = 11;
constexpr double kDegrees = 3.14159265358979 / 180;

motion::Poses InRange(motion::Poses poses, int settled = 0,
                      const motion::Skeleton& skeleton = motion::SbuSkeleton()) {
  KeepJointRanges(skeleton, body::FindBody(skeleton), std::nullopt, {}, {kRate, settled}, &poses);
  return poses;
}

Vec3 Unit(Vec3 v) { return v / Norm(v); }

// Points a bone somewhere in every frame, what hangs on its end not included.
void Point(int from, int to, Vec3 direction, motion::Poses* poses) {
  for (int t = 0; t < poses->frame_count(); ++t) {
    const float length = Distance(poses->at(t, from), poses->at(t, to));
    poses->at(t, to) = poses->at(t, from) + Unit(direction) * length;
  }
}

// A puppet that stands and faces +z, its left at +x, with the left limb from `upper` on pointing as
// told.
motion::Poses Limbs(int upper, Vec3 inner, Vec3 outer) {
  motion::Poses poses = Puppet();
  Point(upper, upper + 1, inner, &poses);
  Point(upper + 1, upper + 2, outer, &poses);
  return poses;
}
motion::Poses Leg(Vec3 thigh, Vec3 shin) { return Limbs(kHip, thigh, shin); }
motion::Poses Arm(Vec3 upper_arm, Vec3 forearm) { return Limbs(kShoulder, upper_arm, forearm); }

// Straight down, turned towards `way` by so many degrees.
Vec3 Down(double degrees, Vec3 way) {
  const float c = static_cast<float>(std::cos(degrees * kDegrees));
  const float s = static_cast<float>(std::sin(degrees * kDegrees));
  return Vec3{0, -c, 0} + way * s;
}
constexpr Vec3 kForwards{0, 0, 1}, kBackwards{0, 0, -1}, kOut{1, 0, 0}, kIn{-1, 0, 0};

double Angle(Vec3 a, Vec3 b) {
  return std::acos(std::clamp<double>(Dot(Unit(a), Unit(b)), -1, 1)) / kDegrees;
}

// The angle between the two bones of a limb that begins at `upper`.
double BendDegrees(const motion::Poses& poses, int upper, int frame = 5) {
  return Angle(poses.at(frame, upper + 1) - poses.at(frame, upper),
               poses.at(frame, upper + 2) - poses.at(frame, upper + 1));
}

// That its end is seen from its upper joint where it was, and that bones keep their lengths.
void ExpectPointsAsBefore(const motion::Poses& after, const motion::Poses& before, int upper) {
  EXPECT_LT(Angle(after.at(5, upper + 2) - after.at(5, upper),
                  before.at(5, upper + 2) - before.at(5, upper)),
            0.1);
  EXPECT_LT(LargestLengthChange(after, before), 1e-5f);
}

TEST(KeepJointRanges, NaturalPosesAreUnchanged) {
  const motion::Poses people[] = {
      Puppet(),
      Leg(Down(0, {}), Down(4, kForwards)),
      Leg(Down(0, {}), Down(100, kBackwards)),
      Leg(kForwards, Down(0, {})),
      Leg(Down(120, kForwards), Down(10, kBackwards)),    // the knee at the chest
      Leg(kForwards, {0.5f, -1, 0}),                      // the shin turned outwards
      Leg({0.6f, -0.5f, 0.8f}, Down(0, {})),              // a horseman's stance
      Arm(Down(0, {}), Down(140, kForwards)),             // a hand at the shoulder
      Arm(Down(0, {}), kIn),                              // a hand at the belly
      Arm(Down(10, kBackwards), Vec3{-1, 0.2f, -0.25f}),  // a hand at the back
      Arm(kOut, {0, 1, 0}),                               // hands up
      Arm(kOut, {0, -1, 0.2f}),                           // hands down
      Arm(kForwards, kIn),                                // arms crossed
      Arm({0.2f, 1, 0}, {-0.5f, 1, -0.3f}),               // a hand over the head
  };
  for (const motion::Poses& pose : people) EXPECT_EQ(InRange(pose), pose) << &pose - people;
}

TEST(KeepJointRanges, AKneeDoesNotBendBackwards) {
  const motion::Poses before = Leg(Down(0, {}), Down(45, kForwards)), after = InRange(before);
  EXPECT_LT(BendDegrees(after, kHip), 10.1);
  ExpectPointsAsBefore(after, before, kHip);
  const Vec3 raised = Vec3{0, 0.7f, 1};  // the thigh forwards, the shin above it
  EXPECT_LT(BendDegrees(InRange(Leg(kForwards, raised)), kHip), 10.1);
}

TEST(KeepJointRanges, AKneeStraightensOnlyAsFarAsTheFloorLetsTheFoot) {
  // A knee that bends backwards over a foot on the floor: straight, the leg would reach below.
  const motion::Poses before = Leg(Down(40, kBackwards), Down(40, kForwards));
  const float floor = before.at(5, kFoot).y, lowest = floor - 0.03f;
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const auto after = [&](std::optional<float> height) {
    motion::Poses poses = before;
    KeepJointRanges(skeleton, body::FindBody(skeleton), height, {}, {kRate, 0}, &poses);
    return poses;
  };
  EXPECT_LT(after(std::nullopt).at(5, kFoot).y, lowest - 0.05f);
  const motion::Poses kept = after(floor);
  EXPECT_NEAR(kept.at(5, kFoot).y, lowest, 0.002);
  EXPECT_LT(BendDegrees(kept, kHip), BendDegrees(before, kHip) - 1);
  ExpectPointsAsBefore(kept, before, kHip);
  // A foot that is below already comes no lower.
  const float sunk = after(floor + 0.5f).at(5, kFoot).y;
  EXPECT_GE(sunk, before.at(5, kFoot).y - 1e-5f);
}

TEST(KeepJointRanges, AKneeDoesNotBendToTheSide) {
  for (const Vec3 side : {kOut, kIn}) {
    const motion::Poses before = Leg(Down(0, {}), Down(40, side)), after = InRange(before);
    EXPECT_LT(BendDegrees(after, kHip), 10.1);
    ExpectPointsAsBefore(after, before, kHip);
  }
}

TEST(KeepJointRanges, NeitherKneesNorElbowsFoldFlat) {
  EXPECT_GT(BendDegrees(Leg(Down(0, {}), Down(175, kBackwards)), kHip), 174);
  EXPECT_LT(BendDegrees(InRange(Leg(Down(0, {}), Down(175, kBackwards))), kHip), 155.1);
  EXPECT_LT(BendDegrees(InRange(Arm(Down(0, {}), Down(175, kForwards))), kShoulder), 155.1);
}

TEST(KeepJointRanges, AnElbowDoesNotBendBackwards) {
  const std::pair<Vec3, Vec3> broken[] = {
      {Down(0, {}), Down(60, kBackwards)}, {kOut, {0.3f, 0, -1}}, {kForwards, {0, -1, 1}}};
  for (const auto& [upper_arm, forearm] : broken) {
    const motion::Poses before = Arm(upper_arm, forearm), after = InRange(before);
    EXPECT_LT(BendDegrees(after, kShoulder), 15);
    ExpectPointsAsBefore(after, before, kShoulder);
  }
}

TEST(KeepJointRanges, ALimbRaisedOppositeToItsRestIsUnchanged) {
  const motion::Poses overhead = Leg({0, 1, 0}, {0, 0.5f, 1}), arm = Arm({0, 1, -0.3f}, {0, 0, 1});
  EXPECT_EQ(InRange(overhead), overhead);
  EXPECT_EQ(InRange(arm), arm);
}

TEST(KeepJointRanges, TheHeadStaysOnTheNeck) {
  motion::Poses nodding = Puppet(), broken = nodding;
  Point(kNeck, kHead, {0, 0.7f, 1}, &nodding);
  EXPECT_EQ(InRange(nodding), nodding);
  Point(kNeck, kHead, {0.2f, -1, 1}, &broken);
  const motion::Poses after = InRange(broken);
  const Vec3 trunk = after.at(5, kNeck) - Lerp(after.at(5, 9), after.at(5, 12), 0.5f);
  EXPECT_LT(Angle(after.at(5, kHead) - after.at(5, kNeck), trunk), 85.1);
  EXPECT_LT(LargestLengthChange(after, broken), 1e-5f);
}

TEST(KeepJointRanges, ABodyMayFaceAnywhere) {
  motion::Poses before = Leg(Down(0, {}), Down(45, kForwards));
  Point(kShoulder, kElbow, Down(0, {}), &before);
  Point(kElbow, kHand, Down(60, kBackwards), &before);
  const auto turned = [](const motion::Poses& poses) {
    return Changed(poses, [](int, Vec3 joint) { return RotateY(joint, 2.4) + Vec3{3, 1, -2}; });
  };
  EXPECT_LT(LargestDistance(InRange(turned(before)), turned(InRange(before))), 1e-4f);
}

TEST(KeepJointRanges, TheRightArmMayComeFirst) {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  std::reverse(skeleton.bones.begin(), skeleton.bones.end());
  ASSERT_NE(body::FindBody(skeleton).arms[0].upper,
            body::FindBody(motion::SbuSkeleton()).arms[0].upper);
  const motion::Poses broken = Arm(Down(0, {}), Down(60, kBackwards));
  EXPECT_EQ(InRange(broken, 0, skeleton), InRange(broken));
  EXPECT_NE(InRange(broken), broken);
}

// A limb that swings evenly from what it may do far beyond it and back.
motion::Poses Swinging(int upper, Vec3 way, double degrees) {
  motion::Poses poses = Puppet();
  for (int t = 0; t < kFrames; ++t) {
    const double share = std::sin(3.14159265 * t / (kFrames - 1));
    motion::Poses frame = Limbs(upper, Down(0, {}), Down(-20 + (degrees + 20) * share, way));
    std::copy(frame[0].begin(), frame[0].end(), poses[t].begin());
  }
  return poses;
}

TEST(KeepJointRanges, CorrectionsAreContinuous) {
  const motion::Poses swings[] = {Swinging(kHip, kForwards, 60), Swinging(kHip, kOut, 60),
                                  Swinging(kHip, kBackwards, 175),
                                  Swinging(kShoulder, kBackwards, 60)};
  for (const motion::Poses& swing : swings) {
    const motion::Poses after = InRange(swing);
    EXPECT_NE(after, swing);
    EXPECT_LT(LargestStep(after), 1.1f * LargestStep(swing)) << &swing - swings;
  }
}

TEST(KeepJointRanges, ContinuesFromSettledFrames) {
  // Within the range until the settled frames end, then beyond it at once.
  motion::Poses broken = Puppet();
  const motion::Poses leg = Leg(Down(0, {}), Down(45, kForwards));
  for (int t = 10; t < kFrames; ++t) std::copy(leg[t].begin(), leg[t].end(), broken[t].begin());
  const motion::Poses after = InRange(broken, 15);
  for (int t = 0; t < 15; ++t) EXPECT_EQ(after[t], broken[t]);
  EXPECT_LT(Distance(after.at(15, kKnee), broken.at(14, kKnee)), 0.02f);
  EXPECT_LT(BendDegrees(after, kHip, 25), 10.1);
  motion::Poses rest = after;
  rest.DropFront(14);
  EXPECT_LT(LargestStep(rest), 0.08f);
}

TEST(KeepJointRanges, SkipsLimbsThatASkeletonLacks) {
  const motion::Poses leg = Leg(Down(0, {}), Down(45, kForwards));
  const motion::Poses arm = Arm(Down(0, {}), Down(60, kBackwards));
  EXPECT_EQ(InRange(leg, 0, WithoutHips()), leg);
  EXPECT_EQ(InRange(arm, 0, WithoutHips()), arm);
  EXPECT_EQ(InRange(leg, 0, WithoutFeet()), leg);
  EXPECT_EQ(InRange(arm, 0, WithoutFeet()), InRange(arm));
}

TEST(KeepJointRanges, ABodyInOnePointStays) {
  const motion::Poses point(kFrames, 15);
  EXPECT_EQ(InRange(point), point);
}

}  // namespace
}  // namespace duet::cleanup
