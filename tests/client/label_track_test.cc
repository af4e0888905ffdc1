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

TEST(LabelTrackTest, AStepKeepsTheOldWeightsUntilTheFrameBefore) {
  LabelTrack track({{0, {{"hug", 1}}}});
  track.Change(10, {{"hug", 2}}, 0);
  EXPECT_THAT(track.From(0), ElementsAre(Key(0, 1), Key(9, 1), Key(10, 2)));
}

TEST(LabelTrackTest, AnEaseBeginsAtTheWeightsOfItsFrame) {
  LabelTrack track({{0, {{"hug", 0}}}});
  track.Change(10, {{"hug", 1}}, 10);
  track.Change(15, {{"hug", 0}}, 5);  // half way
  EXPECT_THAT(track.From(0), ElementsAre(Key(0, 0), Key(10, 0), Key(15, 0.5F), Key(20, 0)));
}

TEST(LabelTrackTest, AChangeDropsLaterKeyframes) {
  LabelTrack track({{0, {{"hug", 0}}}, {100, {{"hug", 1}}}});
  track.Change(50, {{"hug", 2}}, 10);
  EXPECT_THAT(track.From(0), ElementsAre(Key(0, 0), Key(50, 0.5F), Key(60, 2)));
}

TEST(LabelTrackTest, ClassesWithoutAWeightCountAsZero) {
  LabelTrack track({{0, {{"hug", 1}}}});
  track.Change(0, {{"kick", 1}}, 10);
  track.Change(5, {{"kick", 1}}, 0);
  // One frame before the step, of both classes.
  EXPECT_THAT(track.From(4)[0].weights,
              ElementsAre(AllOf(Field(&ClassWeight::interaction_class, "hug"),
                                Field(&ClassWeight::weight, testing::FloatEq(0.6F))),
                          AllOf(Field(&ClassWeight::interaction_class, "kick"),
                                Field(&ClassWeight::weight, testing::FloatEq(0.4F)))));
}

TEST(LabelTrackTest, FromReturnsTheKeyframesThatApply) {
  const LabelTrack track({{0, {{"hug", 0}}}, {10, {{"hug", 1}}}, {20, {{"hug", 2}}}});
  EXPECT_THAT(track.From(9), ElementsAre(Key(0, 0), Key(10, 1), Key(20, 2)));
  EXPECT_THAT(track.From(10), ElementsAre(Key(10, 1), Key(20, 2)));
  EXPECT_THAT(track.From(99), ElementsAre(Key(20, 2)));
}

}  // namespace
}  // namespace duet::client::internal
