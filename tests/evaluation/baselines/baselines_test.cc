#include "model/evaluation/baselines/baselines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/evaluation/protocol/protocol.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::baselines {
namespace {

using test::MadeUpPairs;

double MeanAfd(const dataset::Dataset& dataset, const std::string& name) {
  auto method = MakeBaseline(name);
  EXPECT_THAT(method, IsOk());
  const auto fold = RunFold(dataset, *LeaveSubjectOut(dataset, "a"), method->get());
  EXPECT_THAT(fold, IsOk());
  if (!fold.ok()) return 1e9;
  const std::vector<double> afd = ScoreByClass(dataset, fold->motions).at("afd");
  return (afd[0] + afd[1]) / 2;
}

TEST(BaselinesTest, AreTheRowsOfTheTable) {
  EXPECT_THAT(BaselineNames(), ElementsAre("class_mean", "frozen_first_frame", "nearest_neighbour",
                                           "hmm", "kzbh12", "hk14", "hfkb15"));
  for (const std::string& name : BaselineNames()) {
    const auto method = MakeBaseline(name);
    ASSERT_THAT(method, IsOk());
    EXPECT_EQ((*method)->name(), name);
    EXPECT_EQ((*method)->reads_first_pose(), name == "frozen_first_frame");
  }
  EXPECT_THAT(MakeBaseline("magic"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("class_mean, frozen")));
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

TEST(BaselinesTest, FrozenFirstPoseIsExactForStillFollowers) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  auto method = MakeBaseline("frozen_first_frame");
  ASSERT_THAT(method, IsOk());
  const auto fold = RunFold(dataset, *LeaveSubjectOut(dataset, "a"), method->get());
  ASSERT_THAT(fold, IsOk());
  const metrics::ScoredMotion& motion = fold->motions[0];
  const motion::Clip& truth = dataset.sequences[0].pair.follower;
  // The made-up leader's root never moves: the answer stands still in the world.
  for (int t : {0, 7, truth.frame_count() - 1}) {
    for (int j = 0; j < 15; ++j) {
      EXPECT_LT(Distance(motion.follower.at(t, j), truth.at(0, j)), 1e-5);
    }
  }
}

TEST(BaselinesTest, AnswerTheSameEveryTime) {
  const dataset::Dataset dataset = MadeUpPairs(6);
  for (const char* name : {"kzbh12", "hfkb15"}) {
    EXPECT_EQ(MeanAfd(dataset, name), MeanAfd(dataset, name)) << name;
  }
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
    auto method = MakeBaseline(name);
    ASSERT_THAT(method, IsOk());
    EXPECT_THAT((*method)->Train(dataset, {0, 1}),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("class flinch")));
  }
}

}  // namespace
}  // namespace duet::evaluation::baselines
