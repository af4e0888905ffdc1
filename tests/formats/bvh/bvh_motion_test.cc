#include "model/formats/bvh/bvh_motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "model/retargeting/euler.h"

namespace duet::formats::bvh {
namespace {

using retargeting::AxisAngle;
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

BvhDocument Written(double aside) {
  BvhDocument document = BodyAndArm();
  WriteMotion(RaisesAnArm(aside), kRateHz, &document);
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

TEST(WriteMotion, ThroughGimbalLockNoAngleChangesMoreThanTheArm) {
  EXPECT_LT(LargestStep(Written(0)), 12.001);
}

TEST(WriteMotion, NearGimbalLockAnglesChangeByAQuarterTurnAndTheArms) {
  EXPECT_LT(LargestStep(Written(3)), 102);
}

TEST(WriteMotion, EveryFrameHasTheRotationAndThePlace) {
  const BvhDocument document = Written(3);
  ASSERT_EQ(document.frame_count, kFrames + 1);
  EXPECT_NEAR(document.frame_time_s, 1 / kRateHz, 1e-12);
  const std::vector<BvhTrack> tracks = RaisesAnArm(3);
  for (int frame = 0; frame <= kFrames; ++frame) {
    const auto at = static_cast<std::size_t>(frame);
    const float* values = &document.values[9 * at];
    EXPECT_NEAR(values[0], 0.1 * frame, 1e-6);
    const Quaternion written = retargeting::FromEuler(
        {values[6] * kDegree, values[7] * kDegree, values[8] * kDegree}, {2, 0, 1});
    EXPECT_LT(Angle(written, tracks[1].turns[at]), 1e-4) << frame;
  }
}

TEST(WriteMotion, JointsWithoutThreeRotationsStayAtZero) {
  BvhDocument document = BodyAndArm();
  document.joints[1].channels.pop_back();
  std::vector<BvhTrack> tracks = RaisesAnArm(0);
  WriteMotion(tracks, kRateHz, &document);
  ASSERT_EQ(document.values.size(), (kFrames + 1u) * 8u);
  EXPECT_EQ(document.values[8 * 5 + 6], 0);
  EXPECT_EQ(document.values[8 * 5 + 7], 0);
}

}  // namespace
}  // namespace duet::formats::bvh
