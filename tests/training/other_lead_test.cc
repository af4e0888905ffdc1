#include "model/training/other_lead.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/sample_motion.h"

namespace duet::training {
namespace {

using motion::Vec3;

constexpr double kRate = 15;
constexpr int kFrames = 30, kLast = 10, kJoin = 4;

// The same motion as another person's, at another place and turned.
motion::Poses Elsewhere(motion::Poses poses) {
  for (Vec3& point : poses.all()) point = RotateY(point, 2) + Vec3{3, 0, -1};
  return poses;
}

float Farthest(const motion::Poses& a, const motion::Poses& b, int from) {
  float farthest = 0;
  for (int t = from; t < a.frame_count(); ++t) {
    for (int j = 0; j < a.joint_count(); ++j) {
      farthest = std::max(farthest, Distance(a.at(t, j), b.at(t, j)));
    }
  }
  return farthest;
}

TEST(ContinuedBy, TheSameMotionElsewhereContinuesInPlace) {
  const motion::Poses own = test::SwayingMotion(kFrames, kRate);
  const motion::Poses continued =
      ContinuedBy(motion::SbuSkeleton(), own, kLast, Elsewhere(own), kJoin);
  EXPECT_LT(Farthest(own, continued, 0), 1e-4f);
}

TEST(ContinuedBy, AnotherPoseIsReachedWithoutAJump) {
  const motion::Poses own = test::SwayingMotion(kFrames, kRate);
  motion::Poses other = own;
  constexpr int kHand = 8;
  for (int t = 0; t < kFrames; ++t) other.at(t, kHand).y += 0.5f;
  const motion::Poses continued =
      ContinuedBy(motion::SbuSkeleton(), own, kLast, Elsewhere(other), kJoin);
  for (int t = 0; t <= kLast; ++t) EXPECT_EQ(continued.at(t, kHand), own.at(t, kHand));
  EXPECT_LT(Distance(continued.at(kLast + 1, kHand), own.at(kLast + 1, kHand)), 0.1f);
  EXPECT_LT(Farthest(other, continued, kLast + kJoin + 1), 1e-4f);
}

dataset::Sequence Labelled(int frames, std::vector<dataset::LabelSpan> labels) {
  dataset::Sequence sequence;
  sequence.pair.leader.poses = motion::Poses(frames, 1);
  sequence.labels = std::move(labels);
  return sequence;
}

const dataset::Sequence* Drawn(const dataset::Sequence& own, const dataset::Sequence& other) {
  base::Random random(1);
  const std::vector<dataset::Sequence> sequences = {other};
  return DrawOther(sequences, own, kLast, &random) == nullptr ? nullptr : &other;
}

TEST(DrawOther, SharesNoClassAfterTheLastKnownFrame) {
  const dataset::Sequence own = Labelled(kFrames, {{0, 0, 8}, {1, 8, kFrames}});
  EXPECT_EQ(Drawn(own, Labelled(kFrames, {{1, 20, kFrames}})), nullptr);
  EXPECT_NE(Drawn(own, Labelled(kFrames, {{1, 0, kLast + 1}, {2, 0, kFrames}})), nullptr);
  EXPECT_NE(Drawn(own, Labelled(kFrames, {{0, 0, kFrames}})), nullptr);
}

TEST(DrawOther, IsNotShorterAndHasATimeLine) {
  const dataset::Sequence own = Labelled(kFrames, {{0, 0, kFrames}});
  EXPECT_EQ(Drawn(own, Labelled(kFrames - 1, {{1, 0, kFrames - 1}})), nullptr);
  EXPECT_EQ(Drawn(own, Labelled(kFrames, {})), nullptr);
  EXPECT_EQ(Drawn(Labelled(kFrames, {}), own), nullptr);
}

}  // namespace
}  // namespace duet::training
