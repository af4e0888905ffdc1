#include "model/engine/label_track.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace duet::engine {
namespace {

using ::testing::ElementsAre;

std::vector<float> At(const LabelTrack& track, double frame) {
  std::vector<float> weights(2, -99);
  track.At(frame, weights.data());
  return weights;
}

LabelTrack ThreeKeyframes() {
  return LabelTrack(std::vector<LabelKeyframe>{{10, {1, 0}}, {20, {0, 2}}, {21, {-1, 2}}});
}

TEST(LabelTrack, OneVectorHoldsThroughout) {
  const LabelTrack track(std::vector<float>{1, -0.5f});
  for (double frame : {0.0, 0.25, 7.0, 1e9}) EXPECT_THAT(At(track, frame), ElementsAre(1, -0.5f));
}

TEST(LabelTrack, HitsEveryKeyframe) {
  EXPECT_THAT(At(ThreeKeyframes(), 10), ElementsAre(1, 0));
  EXPECT_THAT(At(ThreeKeyframes(), 20), ElementsAre(0, 2));
  EXPECT_THAT(At(ThreeKeyframes(), 21), ElementsAre(-1, 2));
}

TEST(LabelTrack, IsLinearBetweenKeyframes) {
  EXPECT_THAT(At(ThreeKeyframes(), 12.5), ElementsAre(0.75f, 0.5f));
  EXPECT_THAT(At(ThreeKeyframes(), 20.5), ElementsAre(-0.5f, 2));
}

TEST(LabelTrack, HoldsBeforeTheFirstAndAfterTheLast) {
  EXPECT_THAT(At(ThreeKeyframes(), 0), ElementsAre(1, 0));
  EXPECT_THAT(At(ThreeKeyframes(), 9.9), ElementsAre(1, 0));
  EXPECT_THAT(At(ThreeKeyframes(), 500), ElementsAre(-1, 2));
}

}  // namespace
}  // namespace duet::engine
