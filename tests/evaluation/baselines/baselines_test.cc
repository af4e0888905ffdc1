#include "model/evaluation/baselines/baselines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::baselines {
namespace {

using test::MadeUpPairs;

double MeanAfd(const dataset::Dataset& dataset, const std::string& name) {
  const auto fold = RunBaseline(name, dataset, *LeaveSubjectOut(dataset, "a"));
  EXPECT_THAT(fold, IsOk());
  if (!fold.ok()) return 1e9;
  const std::vector<double> afd = ScoreByClass(dataset, *fold).at("afd");
  return (afd[0] + afd[1]) / 2;
}

TEST(BaselinesTest, AreTheRowsOfTheTable) {
  EXPECT_THAT(BaselineNames(), ElementsAre("class_mean", "frozen_first_frame", "nearest_neighbour",
                                           "hmm", "kzbh12", "hk14", "hfkb15"));
}

TEST(BaselinesTest, AnswerTheTestSequencesWithoutTheFollower) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  const dataset::Split split = *LeaveSubjectOut(dataset, "a");
  dataset::Dataset hidden = dataset;
  for (const int index : split.test) {  // only the first pose is left
    hidden.sequences[static_cast<size_t>(index)].pair.follower.poses.Resize(1);
  }
  for (const std::string& name : BaselineNames()) {
    const auto answers = RunBaseline(name, hidden, split);
    ASSERT_THAT(answers, IsOk());
    ASSERT_THAT(*answers, SizeIs(2));
    EXPECT_EQ(answers->back().sequence, split.test.back());
    EXPECT_EQ(answers->front().follower, RunBaseline(name, dataset, split)->front().follower);
  }
}

// Every method that reads the leader answers a leader that it never saw, anywhere in the world,
// much better than the pose held still that ignores it.
TEST(BaselinesTest, LearnTheMadeUpAnswer) {
  const dataset::Dataset dataset = MadeUpPairs(12);
  const double still = MeanAfd(dataset, "class_mean");
  EXPECT_GT(still, 0.1);
  EXPECT_LT(MeanAfd(dataset, "nearest_neighbour"), 0.5 * still);
  EXPECT_LT(MeanAfd(dataset, "hmm"), 0.5 * still);
  EXPECT_LT(MeanAfd(dataset, "kzbh12"), 0.7 * still);
  EXPECT_LT(MeanAfd(dataset, "hk14"), 0.5 * still);
  EXPECT_LT(MeanAfd(dataset, "hfkb15"), 0.7 * still);
}

TEST(BaselinesTest, WorkWithOneSequenceAClass) {
  // Leaving a out of two subjects leaves one sequence of each class.
  const dataset::Dataset dataset = MadeUpPairs(2);
  for (const std::string& name : BaselineNames()) {
    EXPECT_LT(MeanAfd(dataset, name), 3) << name;
  }
}

TEST(BaselinesTest, NameTheClassWithoutSequences) {
  const dataset::Dataset dataset = MadeUpPairs(2);
  for (const std::string& name : BaselineNames()) {
    if (name == "frozen_first_frame") continue;  // learns nothing
    EXPECT_THAT(RunBaseline(name, dataset, {{0, 1}, {2, 3}}),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("class flinch")));
  }
}

}  // namespace
}  // namespace duet::evaluation::baselines
