// What a live session keeps from one stream to the next: the labels, and the signs of rotations.
#include "client/internal/live_state.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client::internal {
namespace {

auto Key(int frame, float hug) {
  return AllOf(Field(&WeightKeyframe::frame, frame),
               Field(&WeightKeyframe::weights, ElementsAre(Field(&ClassWeight::weight, hug))));
}

TEST(LabelTrackTest, AStepKeepsTheOldWeightsUntilTheFrameBeforeAndAnEaseBeginsAtThem) {
  LabelTrack track({{0, {{"hug", 0}}}, {100, {{"hug", 1}}}});
  track.Change(50, {{"hug", 2}}, 0);
  EXPECT_THAT(track.From(0), ElementsAre(Key(0, 0), Key(49, 0.49F), Key(50, 2)))
      << "later keyframes are dropped";
  track.Change(60, {{"hug", 1}}, 10);
  track.Change(65, {{"hug", 0}}, 5);  // half way
  EXPECT_THAT(track.From(60), ElementsAre(Key(60, 2), Key(65, 1.5F), Key(70, 0)));
  EXPECT_THAT(track.From(64), ElementsAre(Key(60, 2), Key(65, 1.5F), Key(70, 0)))
      << "the keyframe before counts";
  EXPECT_THAT(track.From(99), ElementsAre(Key(70, 0)));
}

TEST(LabelTrackTest, ClassesWithoutAWeightCountAsZero) {
  LabelTrack track({{0, {{"hug", 1}}}});
  track.Change(0, {{"kick", 1}}, 10);
  track.Change(5, {{"kick", 1}}, 0);
  // One frame before the step, of both classes.
  EXPECT_THAT(track.From(4)[0].weights,
              ElementsAre(AllOf(Field(&ClassWeight::interaction_class, "hug"),
                                Field(&ClassWeight::weight, FloatEq(0.6F))),
                          AllOf(Field(&ClassWeight::interaction_class, "kick"),
                                Field(&ClassWeight::weight, FloatEq(0.4F)))));
}

// A frame of a rig of one joint.
v1::FollowerFrames Frame(bool rig, float x, float w) {
  v1::FollowerFrames frames;
  frames.set_frame_count(1);
  if (rig) frames.add_rig()->set_parent(-1);
  if (rig) frames.mutable_rig(0)->set_name("root");
  for (const float value : {x, 0.0F, 0.0F, w}) frames.add_rotations(value);
  return frames;
}

TEST(LiveRotationsTest, TheNearerSignIsChosenAlsoInAnotherStream) {
  LiveRotations rotations(true, 3);
  ASSERT_THAT(rotations.Read(Frame(true, 0.8F, 0.6F), 0), IsOk());
  const auto turned = rotations.Read(Frame(false, -0.8F, 0.6F), 0);
  ASSERT_THAT(turned, IsOk());
  EXPECT_EQ((*turned)->rotations[0].x, 0.8F);
  EXPECT_EQ((*turned)->rotations[0].w, -0.6F);
  rotations.BeginStream();
  const auto resumed = rotations.Read(Frame(true, -0.6F, 0.8F), 0);
  ASSERT_THAT(resumed, IsOk());
  EXPECT_EQ((*resumed)->rotations[0].x, 0.6F);
  EXPECT_EQ((*resumed)->rotations[0].w, -0.8F);
}

TEST(LiveRotationsTest, WhatIsNoRigOrNoRotationIsRejected) {
  const auto refused = [](const v1::FollowerFrames& frames, bool asked, const char* message) {
    EXPECT_THAT(LiveRotations(asked, 3).Read(frames, 0),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(message)));
  };
  refused(Frame(false, 0, 1), true, "frames.rig: expected joints in");
  refused(Frame(true, 1, 1), true, "unit quaternion");
  refused(Frame(true, 0, 1), false, "frames.rig");
  LiveRotations rotations(true, 3);
  ASSERT_THAT(rotations.Read(Frame(true, 0, 1), 0), IsOk());
  EXPECT_THAT(rotations.Read(Frame(true, 0, 1), 0),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("expected joints only")));
}

}  // namespace
}  // namespace duet::client::internal
