#include <cmath>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "model/formats/gltf/gltf_track.h"
#include "tests/formats/gltf/gltf_fixture.h"
#include "tests/support/expect_near.h"
#include "tests/support/matchers.h"

namespace duet::formats::gltf {
namespace {

using retargeting::Quaternion;
using retargeting::Vec3d;
using test::ExpectNear;

using base::kPi;

absl::StatusOr<std::string> NoFiles(const std::string&) { return absl::NotFoundError(""); }

absl::StatusOr<GltfTrack> Track(GltfPath path, GltfInterpolation interpolation,
                                const std::vector<float>& times, const std::vector<float>& values) {
  test::GltfBuilder builder;
  GltfChannel channel;
  channel.path = path;
  channel.interpolation = interpolation;
  channel.times = builder.AddAccessor(times, "SCALAR");
  channel.values = builder.AddAccessor(values, path == GltfPath::kRotation ? "VEC4" : "VEC3");
  const absl::StatusOr<GltfDocument> document = ParseGltf(builder.Binary(), "a.glb");
  EXPECT_TRUE(document.ok()) << document.status();
  const GltfFileReader no_files = NoFiles;
  GltfBuffers buffers(*document, no_files);
  return GltfTrack::Read(channel, &buffers);
}

TEST(GltfTrack, InterpolatesLinearlyAndHoldsItsEnds) {
  const auto track =
      Track(GltfPath::kTranslation, GltfInterpolation::kLinear, {1, 3}, {0, 0, 0, 4, -8, 2});
  ASSERT_TRUE(track.ok()) << track.status();
  ExpectNear(track->VectorAt(0), {0, 0, 0});
  ExpectNear(track->VectorAt(1.5), {1, -2, 0.5});
  ExpectNear(track->VectorAt(3), {4, -8, 2});
  ExpectNear(track->VectorAt(9), {4, -8, 2});
}

TEST(GltfTrack, StaysUntilTheNextStep) {
  const auto track = Track(GltfPath::kScale, GltfInterpolation::kStep, {1, 3}, {1, 1, 1, 2, 2, 2});
  ASSERT_TRUE(track.ok()) << track.status();
  ExpectNear(track->VectorAt(2.999), {1, 1, 1});
  ExpectNear(track->VectorAt(3), {2, 2, 2});
}

// The frames' times are exact, those of the keys are rounded up or down.
TEST(GltfTrack, HasAKeyAtTheTimeOfItsFrame) {
  constexpr double kRateHz = 30;
  std::vector<float> times, values;
  for (int frame = 0; frame < 3000; ++frame) {
    times.push_back(static_cast<float>(2 + frame / kRateHz));
    values.insert(values.end(), 3, static_cast<float>(frame));
  }
  for (const GltfInterpolation interpolation :
       {GltfInterpolation::kLinear, GltfInterpolation::kStep}) {
    const auto track = Track(GltfPath::kTranslation, interpolation, times, values);
    ASSERT_THAT(track, IsOk());
    for (int frame = 0; frame < 3000; ++frame) {
      EXPECT_NEAR(track->VectorAt(2 + frame / kRateHz).x, frame, 1e-3);
    }
  }
}

// A program may write a jump as two keys, a rounding error apart.
TEST(GltfTrack, JumpsAtTheLaterOfTwoKeysAtOneTime) {
  const float before = 1.5f, after = std::nextafter(before, 2.0f);
  const auto track = Track(GltfPath::kScale, GltfInterpolation::kLinear, {1, before, after, 2},
                           {1, 1, 1, 1, 1, 1, 5, 5, 5, 5, 5, 5});
  ASSERT_THAT(track, IsOk());
  ExpectNear(track->VectorAt(1.4999), {1, 1, 1});
  ExpectNear(track->VectorAt(1.5), {5, 5, 5});
}

// 2 t^3 - 3 t^2 + 1 and its neighbours at t = 1/4 and 2 s between keys.
TEST(GltfTrack, FollowsSplines) {
  const auto track = Track(GltfPath::kTranslation, GltfInterpolation::kCubicSpline, {0, 2},
                           {9, 9, 9, 1, 0, 0, 0, 1, 0,  // in, value, out
                            0, 0, 1, 3, 0, 0, 9, 9, 9});
  ASSERT_TRUE(track.ok()) << track.status();
  ExpectNear(track->VectorAt(0.5), {0.84375 * 1 + 0.15625 * 3, 2 * 0.140625, 2 * -0.046875});
  ExpectNear(track->VectorAt(0), {1, 0, 0});
  ExpectNear(track->VectorAt(2), {3, 0, 0});
}

TEST(GltfTrack, RotatesAlongTheShorterArc) {
  const float s = static_cast<float>(std::sin(kPi / 4)), c = static_cast<float>(std::cos(kPi / 4));
  // From no turn to a quarter about z, written as its negative, twice as long.
  const auto track = Track(GltfPath::kRotation, GltfInterpolation::kLinear, {0, 1},
                           {0, 0, 0, 1, 0, 0, -2 * s, -2 * c});
  ASSERT_TRUE(track.ok()) << track.status();
  const Quaternion third = track->RotationAt(1.0 / 3);
  EXPECT_LT(Angle(third, retargeting::AxisAngle({0, 0, 1}, kPi / 6)), 1e-5);
  EXPECT_NEAR(Dot(third, third), 1, 1e-12);
}

TEST(GltfTrack, RejectsInvalidKeys) {
  const auto error = [](const std::vector<float>& times, const std::vector<float>& values,
                        GltfInterpolation interpolation = GltfInterpolation::kLinear) {
    const auto track = Track(GltfPath::kScale, interpolation, times, values);
    EXPECT_EQ(track.status().code(), absl::StatusCode::kInvalidArgument);
    return std::string(track.status().message());
  };
  EXPECT_THAT(error({1, 1}, {1, 1, 1, 2, 2, 2}),
              HasSubstr("accessors[0]: expected increasing times"));
  EXPECT_THAT(error({1, 0}, {1, 1, 1, 2, 2, 2}), HasSubstr("expected increasing times"));
  EXPECT_THAT(
      error({0, 1}, {1, 1, 1}),
      HasSubstr("accessors[1]: expected 1 values for each of at least 1 key, got 1 for 2 keys"));
  EXPECT_THAT(error({0}, {1, 1, 1}, GltfInterpolation::kCubicSpline),
              HasSubstr("expected 3 values for each of at least 1 key, got 1 for 1 keys"));
  EXPECT_THAT(error({}, {}), HasSubstr("at least 1 key, got 0 for 0 keys"));
  EXPECT_THAT(error({0, std::nanf("")}, {1, 1, 1, 2, 2, 2}), HasSubstr("accessors[0]: value 1"));
}

}  // namespace
}  // namespace duet::formats::gltf
