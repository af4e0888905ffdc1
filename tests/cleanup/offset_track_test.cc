#include "model/cleanup/offset_track.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "absl/types/span.h"
#include "gtest/gtest.h"
#include "model/motion/poses.h"
#include "model/motion/resample.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr double kHz = 15;
constexpr int kLength = 60;
constexpr OffsetLimits kLimits = {0.35, 1.5, 4};

std::vector<Vec3> Track(std::vector<Offset> offsets, int settled = 0) {
  return OffsetTrack(std::move(offsets), kLimits, {kHz, settled}, kLength);
}

float FastestOf(const std::vector<Vec3>& track, std::size_t from = 1) {
  float fastest = 0;
  for (std::size_t t = from; t < track.size(); ++t) {
    fastest = std::max(fastest, Distance(track[t], track[t - 1]) * static_cast<float>(kHz));
  }
  return fastest;
}

TEST(OffsetTrack, PassesThroughTheOffsetAndIsZeroFarFromIt) {
  const std::vector<Vec3> track = Track({{30, {0.3f, 0, 0}}});
  EXPECT_EQ(track[30], (Vec3{0.3f, 0, 0}));
  EXPECT_GT(track[28].x, 0.1f);
  EXPECT_EQ(track[20], Vec3());
  EXPECT_EQ(track[40], Vec3());
}

TEST(OffsetTrack, TheSplineBetweenTwoFramesPassesThroughTheOffset) {
  for (const double frame : {30.25, 30.5, 32.8}) {
    const motion::Poses track(1, Track({{frame, {0.3f, 0, 0}}}, 29));
    Vec3 at;
    SampleCubic(track, frame, absl::MakeSpan(&at, 1));
    EXPECT_NEAR(at.x, 0.3f, 0.003f) << frame;
  }
}

TEST(OffsetTrack, LongOffsetsTakeLonger) {
  const std::vector<Vec3> track = Track({{30, {1, 0, 0}}});
  EXPECT_EQ(track[30].x, 1);
  EXPECT_LE(FastestOf(track), 1.5f);
  EXPECT_GT(FastestOf(track), 1.3f);
}

TEST(OffsetTrack, NearOffsetsPassFromOneToTheOther) {
  const std::vector<Vec3> track = Track({{30, {0.3f, 0, 0}}, {33, {0.3f, 0.1f, 0}}});
  for (std::size_t t = 30; t <= 33; ++t) EXPECT_FLOAT_EQ(track[t].x, 0.3f) << t;
  EXPECT_EQ(track[30].y, 0);
  EXPECT_FLOAT_EQ(track[33].y, 0.1f);
}

TEST(OffsetTrack, TheSecondOfTwoThatAreTooNearIsShortened) {
  const std::vector<Vec3> track = Track({{30, {}}, {32, {5, 0, 0}}});
  EXPECT_LE(FastestOf(track), 4.01f);
  EXPECT_GT(track[32].x, 0.3f);
}

TEST(OffsetTrack, SettledFramesStayAndTheWayFromThemIsLimited) {
  const std::vector<Vec3> track = Track({{12, {2, 0, 0}}}, 10);
  for (std::size_t t = 0; t < 10; ++t) EXPECT_EQ(track[t], Vec3()) << t;
  EXPECT_GT(track[12].x, 0.4f);
  EXPECT_LE(FastestOf(track), 4.01f);
}

TEST(OffsetTrack, WithoutSettledFramesTheFirstFrameMayBeFarAway) {
  EXPECT_EQ(Track({{0, {2, 0, 0}}})[0], (Vec3{2, 0, 0}));
}

TEST(OffsetTrack, PreparesForAnOffsetAfterTheEnd) {
  const std::vector<Vec3> track = Track({{kLength + 1, {0.3f, 0, 0}}});
  EXPECT_GT(track[kLength - 1].x, 0.1f);
  EXPECT_LT(track[kLength - 1].x, 0.3f);
}

TEST(OffsetTrack, NoOffsetsAreNoCorrection) {
  for (const Vec3& way : Track({})) EXPECT_EQ(way, Vec3());
}

}  // namespace
}  // namespace duet::cleanup
