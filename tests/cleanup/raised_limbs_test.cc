#include "model/cleanup/raised_limbs.h"

#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

const motion::Skeleton kSkeleton = motion::SbuSkeleton();
const body::Body kBody = body::FindBody(kSkeleton);
constexpr int kHand = 8, kElbow = 7, kShoulder = 6, kFoot = 14, kHip = 12, kOtherFoot = 11;
constexpr float kFloor = static_cast<float>(kAnkle);

// The leader stands three metres away.
motion::Poses Leader() { return Moved(Puppet(), {0, 0, 3}); }

// The right foot is 0.4 m above the floor between two times in seconds.
motion::Poses FootUp(double begin, double end) {
  return Puppet([=](double t, authoring::PuppetPose* pose) {
    if (t >= begin && t < end) pose->right_foot.target = {-0.12, kAnkle + 0.4, 0.3};
  });
}

// The same for the right hand, above the head.
motion::Poses HandUp(double begin, double end) {
  return Puppet([=](double t, authoring::PuppetPose* pose) {
    if (t >= begin && t < end) pose->right_hand.target = {-0.2, 0.6, 0.1};
  });
}

motion::Poses Lowered(motion::Poses poses, int settled = 0,
                      const motion::Poses& leader = Leader()) {
  LowerLimbs(kSkeleton, kBody, kFloor, leader, {}, {kRate, settled}, &poses);
  return poses;
}

// With a limit for hands that are held out, too.
motion::Poses LoweredHands(motion::Poses poses, const motion::Poses& leader = Leader()) {
  RaisedLimbOptions options;
  options.longest_held_out_seconds = 1.2;
  LowerLimbs(kSkeleton, kBody, kFloor, leader, options, {kRate, 0}, &poses);
  return poses;
}

int FrameAt(double seconds) { return static_cast<int>(seconds * kRate); }

TEST(LowerLimbs, AFootThatStaysUpComesDownBelowItsHip) {
  const motion::Poses up = FootUp(0.5, 3.1), lowered = Lowered(up, 1);
  EXPECT_GT(lowered.at(FrameAt(0.9), kFoot).y, kFloor + 0.35f) << "a kick may take a while";
  for (int t = FrameAt(2); t < FrameAt(2.9); ++t) {
    EXPECT_NEAR(lowered.at(t, kFoot).y, kFloor, 0.01f) << t;
    EXPECT_NEAR(lowered.at(t, kFoot).z, lowered.at(t, kHip).z, 0.02f) << t;
    EXPECT_EQ(lowered.at(t, kOtherFoot), up.at(t, kOtherFoot));
  }
  EXPECT_LT(LargestLengthChange(lowered, up), 1e-3f);
}

TEST(LowerLimbs, AFootComesDownNoFasterThanAStep) {
  const motion::Poses lowered = Lowered(FootUp(0.5, 3.1), 1);
  for (int t = FrameAt(0.6); t < FrameAt(2.9); ++t) {
    EXPECT_LT(Distance(lowered.at(t, kFoot), lowered.at(t - 1, kFoot)), 2.0 / kRate) << t;
  }
}

TEST(LowerLimbs, AKickStaysAsItIs) { EXPECT_EQ(Lowered(FootUp(0.5, 1.2), 1), FootUp(0.5, 1.2)); }

TEST(LowerLimbs, AMotionDoesNotBeginWithARaisedFoot) {
  const motion::Poses lowered = Lowered(FootUp(0, 1));
  for (int t = 0; t < FrameAt(0.5); ++t) EXPECT_NEAR(lowered.at(t, kFoot).y, kFloor, 0.01f) << t;
  // The pose that a caller starts from stays.
  EXPECT_EQ(Lowered(FootUp(0, 0.5), 1)[0], FootUp(0, 0.5)[0]);
}

TEST(LowerLimbs, SettledFramesStayAndCount) {
  const motion::Poses up = FootUp(0, 3.1);
  const int settled = FrameAt(0.6);
  const motion::Poses lowered = Lowered(up, settled);
  for (int t = 0; t < settled; ++t) EXPECT_EQ(lowered[t], up[t]);
  EXPECT_NEAR(lowered.at(settled, kFoot).y, up.at(settled, kFoot).y, 0.12f);
  EXPECT_NEAR(lowered.at(FrameAt(1.6), kFoot).y, kFloor, 0.01f);
}

TEST(LowerLimbs, AHandThatStaysUpComesDownBesideTheBody) {
  const motion::Poses up = HandUp(0.5, 3.1), lowered = Lowered(up);
  EXPECT_GT(lowered.at(FrameAt(1.5), kHand).y, lowered.at(0, kShoulder).y + 0.2f);
  const int end = FrameAt(2.8);
  EXPECT_LT(lowered.at(end, kHand).y, lowered.at(end, kShoulder).y - 0.4f);
  EXPECT_LT(LargestLengthChange(lowered, up), 1e-3f);
  EXPECT_EQ(Lowered(HandUp(0.5, 1.8)), HandUp(0.5, 1.8)) << "a greeting";
}

// The right arm is stretched out in a direction between two times in seconds.
motion::Poses ArmOut(Vec3 direction, double begin, double end) {
  motion::Poses poses = Puppet();
  for (int t = FrameAt(begin); t < FrameAt(end); ++t) {
    const Vec3 shoulder = poses.at(t, kShoulder);
    const float upper = Distance(shoulder, poses.at(t, kElbow));
    const float whole = upper + Distance(poses.at(t, kElbow), poses.at(t, kHand));
    poses.at(t, kElbow) = shoulder + direction * upper;
    poses.at(t, kHand) = shoulder + direction * whole;
  }
  return poses;
}

TEST(LowerLimbs, AHandThatIsHeldOutForTooLongComesDown) {
  const motion::Poses out = ArmOut({-1, 0, 0}, 0.5, 3.1), lowered = LoweredHands(out);
  EXPECT_EQ(lowered[FrameAt(1.5)], out[FrameAt(1.5)]);
  const int end = FrameAt(2.8);
  EXPECT_LT(lowered.at(end, kHand).y, lowered.at(end, kShoulder).y - 0.4f);
  EXPECT_EQ(LoweredHands(ArmOut({-1, 0, 0}, 0.5, 1.6)), ArmOut({-1, 0, 0}, 0.5, 1.6));
  EXPECT_EQ(Lowered(out), out) << "no limit";
}

TEST(LowerLimbs, AHandThatReachesForTheLeaderStays) {
  const motion::Poses out = ArmOut({0, 0, 1}, 0.5, 3.1);
  EXPECT_EQ(LoweredHands(out), out);
  EXPECT_NE(LoweredHands(out, Moved(Puppet(), {0, 0, -3})), out) << "the leader is behind";
}

TEST(LowerLimbs, AHandThatTheLeaderHoldsStaysUp) {
  const motion::Poses up = HandUp(0.5, 3.1);
  motion::Poses leader = Leader();
  for (int t = 0; t < kFrames; ++t) leader.at(t, kHand) = up.at(t, kHand) + Vec3{0, 0, 0.2f};
  EXPECT_EQ(Lowered(up, 0, leader), up);
}

TEST(LowerLimbs, SkeletonsThatLackSomethingKeepTheirLimbs) {
  motion::Poses up = FootUp(0.5, 3.1);
  const motion::Poses before = up;
  LowerLimbs(WithoutHips(), body::FindBody(WithoutHips()), kFloor, Leader(), {}, {kRate, 0}, &up);
  EXPECT_EQ(up, before);
  LowerLimbs(WithoutFeet(), body::FindBody(WithoutFeet()), std::nullopt, Leader(), {}, {kRate, 0},
             &up);
  EXPECT_EQ(up, before);
}

}  // namespace
}  // namespace duet::cleanup
