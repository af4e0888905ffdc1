#include "model/formats/bvh/bvh_motion.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "tests/support/matchers.h"

namespace duet::formats::bvh {
namespace {

using retargeting::AxisAngle;
using retargeting::EulerOrder;
using retargeting::Quaternion;

constexpr double kDegree = base::kRadiansPerDegree;
constexpr double kRateHz = 30;
constexpr int kFrames = 15;  // after the first

// A body and an arm that hangs from it, both with z, x, y: x is the middle.
BvhDocument BodyAndArm() {
  const std::vector<BvhChannel> turns = {BvhChannel::kZRotation, BvhChannel::kXRotation,
                                         BvhChannel::kYRotation};
  BvhDocument document;
  document.joints = {{"body", -1, {}, turns, false}, {"arm", 0, {0, -1, 0}, turns, false}};
  document.joints[0].channels.insert(
      document.joints[0].channels.begin(),
      {BvhChannel::kXPosition, BvhChannel::kYPosition, BvhChannel::kZPosition});
  return document;
}

// The arm goes up in front of the body, past gimbal lock at `aside` degrees, 12 degrees a frame.
std::vector<BvhTrack> RaisesAnArm(double aside) {
  std::vector<BvhTrack> tracks(2);
  for (int frame = 0; frame <= kFrames; ++frame) {
    tracks[0].turns.push_back({});
    tracks[0].places.push_back({0.1 * frame, 0, 0});
    tracks[1].turns.push_back(AxisAngle({0, 0, 1}, aside * kDegree) *
                              AxisAngle({1, 0, 0}, (-12 * frame + 6) * kDegree));
    // Leans to the side as it goes: past the pole, not over it.
    tracks[1].turns.back() = AxisAngle({0, 1, 0}, aside * kDegree) * tracks[1].turns.back();
  }
  return tracks;
}

BvhDocument Written(double aside, const BvhKeys& keys) {
  BvhDocument document = BodyAndArm();
  WriteMotion(RaisesAnArm(aside), kRateHz, keys, &document);
  return document;
}

// Of the arm, whose angles are the last three of nine channels.
double LargestStep(const BvhDocument& document) {
  double largest = 0;
  for (std::size_t i = 9; i < document.values.size(); ++i) {
    if (i % 9 < 6) continue;
    largest = std::max(largest,
                       std::abs(static_cast<double>(document.values[i] - document.values[i - 9])));
  }
  return largest;
}

// How far the arm is off between the written keys, where a program draws lines from angle to angle.
double BetweenKeys(const BvhDocument& document, const std::vector<BvhTrack>& tracks, int keys) {
  const EulerOrder order = {2, 0, 1};
  double largest = 0;
  for (int key = 0; key + 1 < document.frame_count; ++key) {
    const float* a = &document.values[static_cast<std::size_t>(key) * 9 + 6];
    for (const double share : {0.25, 0.5, 0.75}) {
      retargeting::EulerAngles drawn;
      for (std::size_t i = 0; i < 3; ++i) {
        drawn[i] =
            ((1 - share) * static_cast<double>(a[i]) + share * static_cast<double>(a[i + 9])) *
            kDegree;
      }
      const double frame = (key + share) / keys;
      const std::size_t at = static_cast<std::size_t>(frame);
      const Quaternion truth = retargeting::Slerp(tracks[1].turns[at], tracks[1].turns[at + 1],
                                                  frame - static_cast<double>(at));
      largest = std::max(largest, Angle(retargeting::FromEuler(drawn, order), truth));
    }
  }
  return largest / kDegree;
}

TEST(WriteMotion, ThroughGimbalLockNoAngleChangesMoreThanTheArm) {
  std::vector<std::string> notes;
  const BvhDocument document = Written(0, {1, &notes});
  EXPECT_LT(LargestStep(document), 12.001);
  EXPECT_LT(BetweenKeys(document, RaisesAnArm(0), 1), 0.01);
  EXPECT_TRUE(notes.empty()) << notes[0];
}

TEST(WriteMotion, NearGimbalLockReportsTheErrorAndSufficientKeys) {
  std::vector<std::string> notes;
  const BvhDocument document = Written(3, {1, &notes});
  EXPECT_LT(LargestStep(document), 102);  // a quarter turn, and the arm's own 12
  const double off = BetweenKeys(document, RaisesAnArm(3), 1);
  EXPECT_GT(off, 1);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0], HasSubstr("\"arm\" comes near gimbal lock"));
  EXPECT_THAT(notes[0], HasSubstr("4 keys per frame reduce this below 1"));
}

TEST(WriteMotion, KeysBetweenFramesStayNearTheMotion) {
  std::vector<std::string> notes;
  const BvhDocument document = Written(3, {4, &notes});
  EXPECT_TRUE(notes.empty()) << notes[0];
  EXPECT_EQ(document.frame_count, 4 * kFrames + 1);
  EXPECT_NEAR(document.frame_time_s, 1 / (4 * kRateHz), 1e-12);
  EXPECT_LT(BetweenKeys(document, RaisesAnArm(3), 4), 1);
  // Places are between as well.
  EXPECT_NEAR(static_cast<double>(document.values[9]), 0.025, 1e-6);
}

TEST(WriteMotion, JointsWithoutThreeRotationsStayAtZero) {
  BvhDocument document = BodyAndArm();
  document.joints[1].channels.pop_back();
  std::vector<BvhTrack> tracks = RaisesAnArm(0);
  WriteMotion(tracks, kRateHz, {}, &document);
  ASSERT_EQ(document.values.size(), (kFrames + 1u) * 8u);
  EXPECT_EQ(document.values[8 * 5 + 6], 0);
  EXPECT_EQ(document.values[8 * 5 + 7], 0);
}

}  // namespace
}  // namespace duet::formats::bvh
