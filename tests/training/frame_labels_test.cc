#include <gmock/gmock.h>

#include <algorithm>

#include "model/training/sampler.h"
#include "tests/support/matchers.h"
#include "tests/training/test_options.h"

namespace duet::training {
namespace {

constexpr int kClasses = 2;

// Eight frames: class 0 in the first five, class 1 from the fourth on.
dataset::Sequence Labelled() {
  dataset::Sequence sequence;
  sequence.pair.leader.poses = motion::Poses(8, 1);
  sequence.labels = {{0, 0, 5}, {1, 3, 8}};
  return sequence;
}

std::vector<float> OfClass(const std::vector<float>& weights, int c) {
  std::vector<float> one;
  for (std::size_t i = static_cast<std::size_t>(c); i < weights.size(); i += kClasses) {
    one.push_back(weights[i]);
  }
  return one;
}

TEST(FrameLabelsTest, FollowTheTimeLine) {
  base::Random random(1);
  const std::vector<float> weights = DrawFrameLabels(Labelled(), kClasses, {}, &random);
  EXPECT_THAT(OfClass(weights, 0), ElementsAre(1, 1, 1, 1, 1, 0, 0, 0));
  EXPECT_THAT(OfClass(weights, 1), ElementsAre(0, 0, 0, 1, 1, 1, 1, 1));
}

TEST(FrameLabelsTest, WithoutATimeLineTheClassIsInEveryFrame) {
  dataset::Sequence sequence = Labelled();
  sequence.labels.clear();
  sequence.interaction_class = 1;
  base::Random random(1);
  const std::vector<float> weights = DrawFrameLabels(sequence, kClasses, {}, &random);
  EXPECT_THAT(OfClass(weights, 0), Each(0));
  EXPECT_THAT(OfClass(weights, 1), Each(1));
}

TEST(FrameLabelsTest, AvoidedClassesAreBelowZeroWhereTheyAreAbsent) {
  base::Random random(1);
  const auto options = Settings<FlowSettings::FrameLabels>("avoided: 1");
  const std::vector<float> weights = DrawFrameLabels(Labelled(), kClasses, options, &random);
  EXPECT_THAT(OfClass(weights, 0), ElementsAre(1, 1, 1, 1, 1, -1, -1, -1));
}

TEST(FrameLabelsTest, OnlyEdgesWithinTheClipShift) {
  base::Random random(1);
  bool shifted = false;
  const auto options = Settings<FlowSettings::FrameLabels>("shift: 2");
  for (int draw = 0; draw < 50; ++draw) {
    const std::vector<float> weights = DrawFrameLabels(Labelled(), kClasses, options, &random);
    const std::vector<float> first = OfClass(weights, 0);
    EXPECT_TRUE(std::is_sorted(first.rbegin(), first.rend()));
    const std::vector<float> second = OfClass(weights, 1);
    EXPECT_TRUE(std::is_sorted(second.begin(), second.end()));
    shifted = shifted || first[4] == 0 || first[5] == 1;
  }
  EXPECT_TRUE(shifted);
}

}  // namespace
}  // namespace duet::training
