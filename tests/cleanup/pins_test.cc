#include "model/cleanup/pins.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "model/cleanup/clean_up.h"
#include "model/motion/resample.h"
#include "tests/cleanup/bodies.h"

namespace duet::cleanup {
namespace {

using motion::Pin;
using motion::Pins;
using motion::Vec3;

constexpr int kHead = 0, kTorso = 2, kRightShoulder = 6, kRightElbow = 7, kRightHand = 8,
              kLeftFoot = 11, kRightKnee = 13, kRightFoot = 14;
constexpr float kReached = 0.01f;

// Stands opposite a leader who faces the follower.
motion::Poses Leader() { return Puppet(); }
motion::Poses Follower() {
  return Changed(Puppet(), [](int, Vec3 joint) { return Vec3{-joint.x, joint.y, 1.3f - joint.z}; });
}

// The stages of a pipeline that concern pins.
motion::Poses Pinned(motion::Poses follower, const Pins& pins, int settled = 0,
                     const motion::Skeleton& skeleton = motion::SbuSkeleton()) {
  const CleanUp clean_up(skeleton);
  const motion::Poses leader = Leader();
  const Timing timing{kRate, settled};
  const std::size_t frames = static_cast<std::size_t>(follower.frame_count());
  const PinnedMotion pinned = clean_up.ApproachPins(leader, Touch(frames), pins, timing, &follower);
  clean_up.PlaceFeet(leader, timing, &follower);
  clean_up.PlaceHands(leader, Meetings(frames), timing, &follower);
  clean_up.PlacePins(pinned, leader, timing, &follower);
  return follower;
}

motion::Poses Unpinned() { return Pinned(Follower(), {}); }

float Misses(const motion::Poses& poses, const Pin& pin) {
  std::vector<Vec3> pose(15);
  SampleCubic(poses, pin.frame, absl::MakeSpan(pose));
  return Distance(pose[static_cast<std::size_t>(pin.joint)], pin.position);
}

// From where the joint of the unpinned motion is.
Pin Away(int joint, double frame, Vec3 way, float softness = 0) {
  return {joint, frame, Unpinned().at(static_cast<int>(frame), joint) + way, softness};
}

// How far a joint moves along the floor from the frame before.
float LevelStep(const motion::Poses& poses, int joint, int frame) {
  Vec3 way = poses.at(frame, joint) - poses.at(frame - 1, joint);
  way.y = 0;
  return Norm(way);
}

float LargestFootStep(const motion::Poses& poses, int foot) {
  float largest = 0;
  for (int t = 1; t < poses.frame_count(); ++t) {
    largest = std::max(largest, Distance(poses.at(t, foot), poses.at(t - 1, foot)));
  }
  return largest;
}

TEST(Pins, AHandIsThereAndTheRestStays) {
  const Pin pin = Away(kRightHand, 23, {0.1f, 0.4f, -0.25f});
  const motion::Poses pinned = Pinned(Follower(), {pin});
  EXPECT_LT(Misses(pinned, pin), kReached);
  EXPECT_LT(LargestLengthChange(pinned, Follower()), 1e-4f);
  for (const int joint : {kHead, kTorso, kLeftFoot, kRightFoot, kRightShoulder}) {
    EXPECT_LT(Distance(pinned.at(23, joint), Unpinned().at(23, joint)), 1e-4f) << joint;
  }
}

TEST(Pins, FramesFarFromThePinDoNotChangeABit) {
  const motion::Poses pinned = Pinned(Follower(), {Away(kRightHand, 23, {0.1f, 0.4f, -0.25f})});
  for (const int t : {0, 3, 43, 45}) {
    for (int j = 0; j < 15; ++j) EXPECT_EQ(pinned.at(t, j), Unpinned().at(t, j)) << t;
  }
}

TEST(Pins, TheHandComesAndGoesWithoutJumps) {
  const motion::Poses pinned = Pinned(Follower(), {Away(kRightHand, 23, {0.1f, 0.4f, -0.25f})});
  EXPECT_LT(LargestStep(pinned), 2.0f / static_cast<float>(kRate));
}

TEST(Pins, APinBetweenTwoFramesIsMet) {
  for (const double frame : {20.25, 20.5, 20.9}) {
    Pin pin = Away(kRightHand, frame, {0.1f, 0.35f, -0.2f});
    EXPECT_LT(Misses(Pinned(Follower(), {pin}), pin), kReached) << frame;
  }
}

TEST(Pins, SoftnessLetsItsShareOfTheDistanceRemain) {
  const float whole = Misses(Unpinned(), Away(kRightHand, 23, {0, 0.4f, -0.2f}));
  for (const float softness : {0.25f, 0.5f, 1.0f}) {
    const Pin pin = Away(kRightHand, 23, {0, 0.4f, -0.2f}, softness);
    EXPECT_NEAR(Misses(Pinned(Follower(), {pin}), pin), softness * whole, kReached) << softness;
  }
}

TEST(Pins, ACompletelySoftPinChangesNothing) {
  EXPECT_EQ(Pinned(Follower(), {Away(kRightHand, 23, {0, 0.4f, 0}, 1)}), Unpinned());
}

TEST(Pins, BothHandsAndASeriesOfFramesAreMet) {
  Pins pins;
  for (int t = 15; t <= 30; t += 3) {
    const float share = static_cast<float>(t - 15) / 15;
    pins.push_back(Away(kRightHand, t, {0.1f * share, 0.3f + 0.2f * share, -0.2f}));
    pins.push_back(Away(5, t, {0, 0.3f, -0.2f * share}));
  }
  const motion::Poses pinned = Pinned(Follower(), pins);
  for (const Pin& pin : pins) EXPECT_LT(Misses(pinned, pin), kReached) << pin.frame;
  EXPECT_LT(LargestStep(pinned), 2.0f / static_cast<float>(kRate));
}

TEST(Pins, TheBodyStepsTowardsAPinThatTheArmDoesNotReach) {
  const Pin pin = Away(kRightHand, 23, {0.6f, 0.45f, -0.4f});
  const motion::Poses pinned = Pinned(Follower(), {pin});
  EXPECT_LT(Misses(pinned, pin), 0.03f);
  EXPECT_GT(Distance(pinned.at(23, kTorso), Unpinned().at(23, kTorso)), 0.05f);
  EXPECT_LT(LargestLengthChange(pinned, Follower()), 1e-4f);
}

TEST(Pins, TheBodyGoesToAPinOfTheRootAndItsFeetStep) {
  const Pin pin = Away(kTorso, 23, {0.3f, 0, 0.2f});
  const motion::Poses pinned = Pinned(Follower(), {pin});
  EXPECT_LT(Misses(pinned, pin), kReached);
  EXPECT_LT(LargestLengthChange(pinned, Follower()), 1e-4f);
  // In every frame at least one foot stands; its heel may rise.
  for (int t = 1; t < kFrames; ++t) {
    EXPECT_LT(std::min(LevelStep(pinned, kLeftFoot, t), LevelStep(pinned, kRightFoot, t)), 0.01f)
        << t;
  }
}

TEST(Pins, ALowPinOfTheHeadBendsTheKneesAboveStandingFeet) {
  const Pin pin = Away(kHead, 23, {0, -0.2f, 0});
  const motion::Poses pinned = Pinned(Follower(), {pin});
  EXPECT_LT(Misses(pinned, pin), kReached);
  for (const int foot : {kLeftFoot, kRightFoot}) {
    EXPECT_LT(LargestFootStep(pinned, foot), 0.01f);
    EXPECT_NEAR(pinned.at(23, foot).y, kAnkle, 0.03f);
  }
}

TEST(Pins, AFootAndAKneeAreThere) {
  const Pin foot = Away(kRightFoot, 23, {0, 0.3f, -0.3f});
  const motion::Poses raised = Pinned(Follower(), {foot});
  EXPECT_LT(Misses(raised, foot), kReached);
  EXPECT_LT(raised.at(23, kRightKnee).z, Unpinned().at(23, kRightKnee).z - 0.1f) << "bent forwards";
  // A knee can only turn about the line from hip to foot: it gets nearer, and the foot stays.
  const Pin knee = Away(kRightKnee, 23, {0.1f, 0, 0});
  const motion::Poses turned = Pinned(Follower(), {knee});
  EXPECT_LT(Misses(turned, knee), Misses(Unpinned(), knee));
  EXPECT_LT(Distance(turned.at(23, kRightFoot), Unpinned().at(23, kRightFoot)), 0.02f);
}

TEST(Pins, AnElbowIsThereAndKeepsItsAngle) {
  const motion::Poses before = Unpinned();
  const float length = Distance(before.at(23, kRightShoulder), before.at(23, kRightElbow));
  const Vec3 way = Vec3{1, 0.2f, -0.4f};
  const Pin pin = {kRightElbow, 23, before.at(23, kRightShoulder) + way * (length / Norm(way))};
  const motion::Poses pinned = Pinned(Follower(), {pin});
  EXPECT_LT(Misses(pinned, pin), 0.02f);
  EXPECT_NEAR(Distance(pinned.at(23, kRightShoulder), pinned.at(23, kRightHand)),
              Distance(before.at(23, kRightShoulder), before.at(23, kRightHand)), 0.02f);
}

TEST(Pins, AJointThatCannotGetThereGetsAsCloseAsItCan) {
  const Pin pin = Away(kRightHand, 23, {0, 3, 0});
  const motion::Poses pinned = Pinned(Follower(), {pin});
  const Vec3 arm = pinned.at(23, kRightHand) - pinned.at(23, kRightShoulder);
  EXPECT_GT(arm.y / Norm(arm), 0.95f) << "stretched upwards";
  EXPECT_GT(Misses(pinned, pin), 1);
  EXPECT_LT(LargestLengthChange(pinned, Follower()), 1e-4f);
}

TEST(Pins, AnElbowDoesNotFoldBeyondItsRange) {
  const Pin pin = {kRightHand, 23, Unpinned().at(23, kRightShoulder) + Vec3{0, 0, -0.03f}};
  const motion::Poses pinned = Pinned(Follower(), {pin});
  const Vec3 upper = pinned.at(23, kRightShoulder) - pinned.at(23, kRightElbow);
  const Vec3 fore = pinned.at(23, kRightHand) - pinned.at(23, kRightElbow);
  const double between = std::acos(Dot(upper, fore) / (Norm(upper) * Norm(fore)));
  EXPECT_LT(180 - between * 180 / 3.14159265, 156);
}

// The largest speed that a pin adds to a joint, relative to the shoulder, metres per second.
float AddedSpeed(const motion::Poses& free, const motion::Poses& pinned, int joint, int shoulder) {
  float largest = 0;
  const auto added = [&](int t) {
    return (pinned.at(t, joint) - pinned.at(t, shoulder)) -
           (free.at(t, joint) - free.at(t, shoulder));
  };
  for (int t = 1; t < free.frame_count(); ++t) {
    largest = std::max(largest, Distance(added(t), added(t - 1)));
  }
  return largest * static_cast<float>(kRate);
}

TEST(Pins, AHandThatIsPinnedNearItsShoulderIsNotThrown) {
  const motion::Poses free = Unpinned();
  for (const Vec3 way : {Vec3{}, Vec3{0, 0.1f, 0}, Vec3{0.03f, -0.05f, 0.05f}, Vec3{0, 0, 0.01f},
                         Vec3{0, -0.1f, 0.12f}}) {
    for (const int frame : {3, 14, 23, 40}) {
      const Pin pin = {kRightHand, static_cast<double>(frame),
                       free.at(frame, kRightShoulder) + way};
      const motion::Poses pinned = Pinned(Follower(), {pin});
      for (const int joint : {kRightElbow, kRightHand}) {
        EXPECT_LT(AddedSpeed(free, pinned, joint, kRightShoulder), 4.5f) << frame << " " << way.y;
      }
      EXPECT_LT(Misses(pinned, pin), Misses(free, pin)) << frame << " " << way.y;
    }
  }
}

TEST(Pins, OnlyThePinThatIsTooFastIsApproachedLess) {
  const motion::Poses free = Unpinned();
  const Pin calm = Away(kRightHand, 8, {0, 0.3f, -0.1f});
  const Pin behind = {kRightHand, 35, free.at(35, kRightShoulder) + Vec3{0, 0.2f, 0.5f}};
  const Pin ahead = {kRightHand, 36, free.at(36, kRightShoulder) + Vec3{0, 0.1f, -0.5f}};
  const motion::Poses pinned = Pinned(Follower(), {calm, behind, ahead});
  EXPECT_LT(Misses(pinned, calm), kReached);
  EXPECT_GT(Misses(pinned, ahead), 0.1f);
  EXPECT_LT(AddedSpeed(free, pinned, kRightHand, kRightShoulder), 4.5f);
}

TEST(Pins, TheHeelOfAStandingFootRisesForAPinnedBody) {
  float highest = 0;
  for (const Vec3 way : {Vec3{0.3f, 0, 0.2f}, Vec3{0.4f, 0, 0}, Vec3{0.5f, 0, 0.2f}}) {
    const Pin pin = Away(kTorso, 20, way);
    const motion::Poses pinned = Pinned(Follower(), {pin});
    EXPECT_LT(Misses(pinned, pin), kReached) << way.x;
    EXPECT_LT(LargestLengthChange(pinned, Follower()), 1e-4f) << way.x;
    for (int t = 1; t < kFrames; ++t) {
      for (const int foot : {kLeftFoot, kRightFoot}) {
        if (LevelStep(pinned, foot, t) < 0.002f) highest = std::max(highest, pinned.at(t, foot).y);
      }
    }
  }
  EXPECT_GT(highest, kAnkle + 0.01f);
  EXPECT_LT(highest, kAnkle + 0.075f);
}

TEST(Pins, ABodyDoesNotWalkAwayForAHandThatIsPinnedFarAway) {
  const Pin pin = Away(kRightHand, 23, {12, 0, 0});
  const motion::Poses pinned = Pinned(Follower(), {pin});
  for (int t = 0; t < kFrames; ++t) {
    EXPECT_LT(Distance(pinned.at(t, kTorso), Unpinned().at(t, kTorso)), 1.1f) << t;
  }
}

TEST(Pins, AHeadInTheLeadersPlaceDoesNotMergeWithIt) {
  const Pin pin = {kHead, 23, Leader().at(23, kHead)};
  const motion::Poses pinned = Pinned(Follower(), {pin});
  for (int t = 0; t < kFrames; ++t) {
    EXPECT_GT(Distance(pinned.at(t, kHead), Leader().at(t, kHead)), 0.15f) << t;
  }
  EXPECT_LT(Misses(pinned, pin), Misses(Unpinned(), pin));
}

TEST(Pins, SettledFramesStayAndThePinIsMetAfterThem) {
  const Pin pin = Away(kRightHand, 22, {0, 0.4f, -0.2f});
  const motion::Poses pinned = Pinned(Follower(), {pin}, 15);
  for (int t = 0; t < 15; ++t) {
    for (int j = 0; j < 15; ++j) EXPECT_EQ(pinned.at(t, j), Follower().at(t, j));
  }
  EXPECT_LT(Misses(pinned, pin), kReached);
}

TEST(Pins, APinRightAfterSettledFramesDoesNotMakeTheHandJump) {
  const motion::Poses pinned = Pinned(Follower(), {Away(kRightHand, 15, {0, 0.6f, -0.3f})}, 15);
  EXPECT_LT(LargestStep(pinned), 4.5f / static_cast<float>(kRate));
}

TEST(Pins, PinsInSettledFramesHaveNoEffect) {
  const Pins pins = {Away(kRightHand, 3, {0, 0.5f, 0}), Away(kTorso, 5, {1, 0, 0})};
  EXPECT_EQ(Pinned(Follower(), pins, 15), Pinned(Follower(), {}, 15));
}

TEST(Pins, ASkeletonWithoutLimbsMovesAsAWhole) {
  motion::Skeleton skeleton = WithoutFeet();
  skeleton.hips.reset();
  const Pin pin = Away(kRightHand, 23, {0.2f, 0.1f, 0.1f});
  const motion::Poses pinned = Pinned(Follower(), {pin}, 0, skeleton);
  EXPECT_LT(Misses(pinned, pin), kReached);
  EXPECT_NEAR(Distance(pinned.at(23, kHead), Follower().at(23, kHead)), 0.245f, kReached);
}

TEST(Pins, TheMeanDistanceCountsPinsOfNewFramesOnly) {
  const motion::Poses poses = Follower();
  const Pin near = {kRightHand, 20, poses.at(20, kRightHand) + Vec3{0, 0.1f, 0}};
  const Pin far = {kHead, 30, poses.at(30, kHead) + Vec3{0.3f, 0, 0}};
  EXPECT_NEAR(MeanPinDistance({near, far}, poses, 0), 0.2, 1e-5);
  EXPECT_NEAR(MeanPinDistance({near, far}, poses, 25), 0.3, 1e-5);
  EXPECT_EQ(MeanPinDistance({{kHead, 99, {}}}, poses, 0), 0);
  EXPECT_EQ(MeanPinDistance({}, poses, 0), 0);
}

}  // namespace
}  // namespace duet::cleanup
