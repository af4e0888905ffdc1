#include <gmock/gmock.h>

#include <set>
#include <string>

#include "model/training/sampler.h"
#include "tests/training/made_up_dataset.h"

namespace duet::training {
namespace {

constexpr int kDraws = 300;

// Every kind of label vector, drawn for one sequence.
std::vector<Example> Draw(const dataset::Dataset& dataset, StartKnowledge start) {
  base::Random random(11, 0);
  std::vector<Example> examples;
  for (int i = 0; i < kDraws; ++i) {
    examples.push_back(CapturedExample(dataset, dataset.sequences[0], start));
    GradeLabels(dataset, dataset.sequences, &random, &examples.back());
  }
  return examples;
}

bool Near(absl::Span<const motion::Vec3> a, absl::Span<const motion::Vec3> b) {
  for (size_t i = 0; i < a.size(); ++i) {
    if (Distance(a[i], b[i]) > 1e-4f) return false;
  }
  return a.size() == b.size();
}

std::string KindOf(const Example& example) {
  const float own = example.weights[0], other = example.weights[1] + example.weights[2];
  if (own < 0) return "negative";
  if (other < 0) return "other avoided";
  if (other == 0) return "graded";
  return own > 0 ? "mixed" : "other alone";
}

TEST(GradedLabelsTest, DrawsEveryKindOfLabelVector) {
  const dataset::Dataset dataset = MadeUpDataset();
  std::set<std::string> kinds;
  for (const Example& example : Draw(dataset, StartKnowledge::kNone)) {
    EXPECT_FALSE(example.single);
    EXPECT_EQ(example.target.frame_count(), dataset.sequences[0].pair.follower.frame_count());
    for (const float weight : example.weights) EXPECT_LE(std::abs(weight), 2);
    kinds.insert(KindOf(example));
  }
  EXPECT_EQ(kinds.size(), 5u);
}

TEST(GradedLabelsTest, OwnWeightScalesTheCapturedReaction) {
  const dataset::Dataset dataset = MadeUpDataset();
  const motion::Clip& follower = dataset.sequences[0].pair.follower;
  int checked = 0;
  for (const Example& example : Draw(dataset, StartKnowledge::kNone)) {
    if (KindOf(example) != "graded") continue;
    const int frame = 7, joint = 5;
    const motion::Vec3 still = follower.at(0, joint), captured = follower.at(frame, joint);
    EXPECT_LT(
        Distance(example.target.at(frame, joint), still + (captured - still) * example.weights[0]),
        1e-5f);
    ++checked;
  }
  EXPECT_GT(checked, 20);
}

TEST(GradedLabelsTest, OtherReactionsAreMovedToThePlaceOfThisOne) {
  dataset::Dataset dataset = MadeUpDataset();
  // The same scene, moved and turned: its follower must be moved back to this place.
  dataset::Sequence& moved = dataset.sequences[1];
  moved = dataset.sequences[0];
  moved.interaction_class = 1;
  for (motion::Clip* clip : {&moved.pair.leader, &moved.pair.follower}) {
    for (motion::Vec3& p : clip->poses.all()) p = RotateY(p, 2) + motion::Vec3{5, 0, 3};
  }
  moved.partner_direction = RotateY(*moved.partner_direction, 2);
  dataset.sequences.resize(2);
  int checked = 0;
  for (const Example& example : Draw(dataset, StartKnowledge::kNone)) {
    if (KindOf(example) != "other alone" || example.weights[1] < 1) continue;
    EXPECT_TRUE(Near(example.target.all(), dataset.sequences[0].pair.follower.poses.all()));
    ++checked;
  }
  EXPECT_GT(checked, 2);
}

}  // namespace
}  // namespace duet::training
