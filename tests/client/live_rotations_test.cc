#include <optional>
#include <vector>

#include "client/internal/rotations.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client::internal {
namespace {

constexpr int kJoints = 3;

// Frames of a rig of one joint, all with the same quaternion.
v1::FollowerFrames Frames(int count, bool rig, float x = 0, float w = 1) {
  v1::FollowerFrames frames;
  frames.set_frame_count(static_cast<uint32_t>(count));
  if (rig) {
    frames.add_rig()->set_name("root");
    frames.mutable_rig(0)->set_parent(-1);
  }
  for (int i = 0; i < count; ++i) {
    for (const float value : {x, 0.0F, 0.0F, w}) frames.add_rotations(value);
  }
  return frames;
}

TEST(LiveRotationsTest, ReadsTheFramesThatTheCallerDoesNotHave) {
  LiveRotations rotations(true, kJoints);
  const auto read = rotations.Read(Frames(5, true), 2);
  ASSERT_THAT(read, IsOk());
  ASSERT_TRUE(read->has_value());
  EXPECT_THAT((*read)->rig, SizeIs(1));
  EXPECT_THAT((*read)->rotations, SizeIs(3));
}

TEST(LiveRotationsTest, TheNearerSignIsChosenAlsoInAnotherStream) {
  LiveRotations rotations(true, kJoints);
  ASSERT_THAT(rotations.Read(Frames(1, true, 0.8F, 0.6F), 0), IsOk());
  const auto turned = rotations.Read(Frames(1, false, -0.8F, 0.6F), 0);
  ASSERT_THAT(turned, IsOk());
  EXPECT_EQ((*turned)->rotations[0].x, 0.8F);
  EXPECT_EQ((*turned)->rotations[0].w, -0.6F);
  rotations.BeginStream();
  const auto resumed = rotations.Read(Frames(1, true, -0.6F, 0.8F), 0);
  ASSERT_THAT(resumed, IsOk());
  EXPECT_EQ((*resumed)->rotations[0].x, 0.6F);
  EXPECT_EQ((*resumed)->rotations[0].w, -0.8F);
}

TEST(LiveRotationsTest, EveryStreamBeginsWithTheRig) {
  LiveRotations rotations(true, kJoints);
  EXPECT_THAT(
      rotations.Read(Frames(1, false), 0),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("frames.rig: expected joints in")));
  ASSERT_THAT(rotations.Read(Frames(1, true), 0), IsOk());
  EXPECT_THAT(
      rotations.Read(Frames(1, true), 0),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("frames.rig: expected joints only")));
}

TEST(LiveRotationsTest, MalformedRotationsAreRefused) {
  LiveRotations rotations(true, kJoints);
  v1::FollowerFrames few = Frames(2, true);
  few.mutable_rotations()->RemoveLast();
  EXPECT_THAT(rotations.Read(few, 0), StatusIs(absl::StatusCode::kInvalidArgument,
                                               HasSubstr("frames.rotations: expected 8")));
  EXPECT_THAT(LiveRotations(true, kJoints).Read(Frames(1, true, 1, 1), 0),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("unit quaternion")));
  v1::FollowerFrames beyond = Frames(1, true);
  beyond.mutable_rig(0)->set_joint(kJoints);
  EXPECT_THAT(LiveRotations(true, kJoints).Read(beyond, 0),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("frames.rig[0].joint")));
}

TEST(LiveRotationsTest, RotationsThatNobodyAskedForAreRefused) {
  LiveRotations rotations(false, kJoints);
  v1::FollowerFrames frames;
  frames.set_frame_count(1);
  const auto none = rotations.Read(frames, 0);
  ASSERT_THAT(none, IsOk());
  EXPECT_FALSE(none->has_value());
  EXPECT_THAT(rotations.Read(Frames(1, true), 0),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("frames.rig")));
}

}  // namespace
}  // namespace duet::client::internal
