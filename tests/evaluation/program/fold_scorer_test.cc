#include "model/evaluation/program/fold_scorer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/evaluation/baselines/baselines.h"
#include "model/evaluation/program/named_runs.h"
#include "tests/evaluation/support/made_up_pairs.h"

namespace duet::evaluation::program {
namespace {

using test::MadeUpPairs;

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::SizeIs;

// Answers what was captured: it looks the sequence up in a data set of its own.
class Oracle : public protocol::Method {
 public:
  explicit Oracle(const dataset::Dataset& dataset) : dataset_(dataset) {}
  std::string name() const override { return "oracle"; }
  absl::Status Train(const dataset::Dataset&, const std::vector<int>&) override {
    return absl::OkStatus();
  }
  absl::StatusOr<motion::Poses> Predict(const dataset::Sequence& asked) const override {
    for (const dataset::Sequence& sequence : dataset_.sequences) {
      if (sequence.id == asked.id) return sequence.pair.follower.poses;
    }
    return absl::NotFoundError(asked.id);
  }

 private:
  const dataset::Dataset& dataset_;
};

TEST(FoldScorer, ScoresAnOracleLikeTheCapturedFollowers) {
  const dataset::Dataset dataset = MadeUpPairs(6);
  const absl::StatusOr<FoldScorer> scorer = FoldScorer::Create(dataset, {"a", "b"}, true);
  ASSERT_TRUE(scorer.ok()) << scorer.status();
  absl::StatusOr<report::MethodFigures> oracle = scorer->Score(
      "oracle", [&](const std::string&) { return std::make_unique<Oracle>(dataset); });
  ASSERT_TRUE(oracle.ok()) << oracle.status();
  EXPECT_THAT(oracle->by_metric["afd"], ElementsAre(0, 0));
  EXPECT_THAT(oracle->by_metric[report::kFrechet], Each(::testing::DoubleNear(0, 1e-6)));
  absl::StatusOr<report::MethodFigures> captured = scorer->ScoreCaptured();
  ASSERT_TRUE(captured.ok()) << captured.status();
  // These bodies never touch: no depth, which is not a number and equals nothing.
  EXPECT_EQ(oracle->by_metric.erase("penetration_depth_m"), 1u);
  EXPECT_EQ(captured->by_metric.erase("penetration_depth_m"), 1u);
  EXPECT_TRUE(captured->captured);
  EXPECT_EQ(captured->by_metric, oracle->by_metric);
  EXPECT_THAT(oracle->by_metric[report::kDiversity], Each(Gt(0)));
  EXPECT_THAT(scorer->JudgeSettings(), SizeIs(2));
}

TEST(FoldScorer, TrainsNoJudgeUnlessAsked) {
  const dataset::Dataset dataset = MadeUpPairs(6);
  const absl::StatusOr<FoldScorer> scorer = FoldScorer::Create(dataset, {"a"}, false);
  ASSERT_TRUE(scorer.ok()) << scorer.status();
  const absl::StatusOr<report::MethodFigures> mean = scorer->Score(
      "mean", [](const std::string&) { return baselines::MakeBaseline("class_mean"); });
  ASSERT_TRUE(mean.ok()) << mean.status();
  EXPECT_EQ(mean->by_metric.count(report::kAccuracy), 0u);
  EXPECT_THAT(mean->by_metric.at("afd"), Each(Gt(0)));
  EXPECT_THAT(scorer->JudgeSettings(), SizeIs(0));
}

TEST(FoldScorer, UnknownSubjectIsNamed) {
  const absl::Status status = FoldScorer::Create(MadeUpPairs(3), {"zoe"}, false).status();
  EXPECT_TRUE(absl::IsNotFound(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("zoe"));
}

TEST(FoldSubjects, DefaultToEverySubject) {
  dataset::Dataset dataset = MadeUpPairs(3);
  EXPECT_THAT(*FoldSubjects(dataset, {"b"}), ElementsAre("b"));
  EXPECT_THAT(*FoldSubjects(dataset, {}), ElementsAre("a", "b", "c"));
  for (dataset::Sequence& sequence : dataset.sequences) sequence.subjects.clear();
  EXPECT_TRUE(absl::IsInvalidArgument(FoldSubjects(dataset, {}).status()));
}

TEST(ParseRuns, TakesAFolderWithOrWithoutAName) {
  EXPECT_EQ(ParseRuns("ours=runs/x")->name, "ours");
  EXPECT_EQ(ParseRuns("ours=runs/x")->folder, "runs/x");
  EXPECT_EQ(ParseRuns("runs/default")->name, "default");
  EXPECT_EQ(ParseRuns("runs/default/")->name, "default");
  EXPECT_EQ(ParseRuns("runs/default/")->folder, "runs/default/");
  for (const char* bad : {"", "=runs", "ours="}) {
    const absl::Status status = ParseRuns(bad).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << bad << ": " << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("NAME=DIR"));
  }
}

}  // namespace
}  // namespace duet::evaluation::program
