#include "model/evaluation/experiments/augmentation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::experiments {
namespace {

using test::FakeSynthesizer;
using test::MadeUpPairs;

std::vector<int> AllOf(const dataset::Dataset& dataset) {
  std::vector<int> all(dataset.sequences.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

float Own(const SyntheticJob& job) {
  return job.labels[static_cast<size_t>(job.sequence.interaction_class)];
}

float Other(const SyntheticJob& job) {
  return job.labels[static_cast<size_t>(1 - job.sequence.interaction_class)];
}

TEST(PlanSyntheticSetTest, AsksForMatchesAndMixesOfEveryClass) {
  const dataset::Dataset dataset = MadeUpPairs(5);
  const std::vector<SyntheticJob> jobs = PlanSyntheticSet(dataset, AllOf(dataset), {6, 4, 3});
  ASSERT_EQ(jobs.size(), 20u);
  std::map<int, int> matches, mixes;
  std::set<std::string> ids;
  for (const SyntheticJob& job : jobs) {
    ids.insert(job.sequence.id);
    ++(Other(job) == 0 ? matches : mixes)[job.sequence.interaction_class];
    EXPECT_GE(Own(job), 0.75f);
    EXPECT_LE(Own(job), Other(job) == 0 ? 1.25f : 1.0f);
    if (Other(job) != 0) {
      EXPECT_GE(Other(job), 0.1f);
      EXPECT_LE(Other(job), 0.35f);
    }
  }
  EXPECT_EQ(ids.size(), jobs.size());
  EXPECT_EQ(matches, (std::map<int, int>{{0, 6}, {1, 6}}));
  EXPECT_EQ(mixes, (std::map<int, int>{{0, 4}, {1, 4}}));
}

TEST(PlanSyntheticSetTest, UsesOnlyLeadersOfTheTrainingHalf) {
  dataset::Dataset dataset = MadeUpPairs(6);
  const dataset::Split split = *SplitInHalves(dataset, 1);
  for (const int test : split.test) {  // would show in what is drawn
    for (motion::Vec3& point :
         dataset.sequences[static_cast<size_t>(test)].pair.leader.poses.all()) {
      point = {1e6f, 1e6f, 1e6f};
    }
  }
  for (const SyntheticJob& job : PlanSyntheticSet(dataset, split.train, {5, 5, 2})) {
    EXPECT_TRUE(job.sequence.pair.follower.poses.empty());
    for (const motion::Vec3& point : job.sequence.pair.leader.poses.all())
      ASSERT_LT(Norm(point), 1e3f);
  }
}

TEST(PlanSyntheticSetTest, OnlyTheSeedDeterminesTheVariation) {
  const dataset::Dataset dataset = MadeUpPairs(4);
  const auto first = PlanSyntheticSet(dataset, AllOf(dataset), {4, 4, 1});
  const auto again = PlanSyntheticSet(dataset, AllOf(dataset), {4, 4, 1});
  const auto other = PlanSyntheticSet(dataset, AllOf(dataset), {4, 4, 2});
  std::set<float> seen;
  for (size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].labels, again[i].labels);
    EXPECT_EQ(first[i].sequence.pair.leader.poses, again[i].sequence.pair.leader.poses);
    EXPECT_NE(first[i].labels, other[i].labels);
    seen.insert(first[i].sequence.pair.leader.poses.all().back().x);
  }
  EXPECT_EQ(seen.size(), first.size());  // no leader twice
}

TEST(SynthesizeJobsTest, AnswersEveryJobAndRefusesAModelOfOtherClasses) {
  dataset::Dataset dataset = MadeUpPairs(2);
  const std::vector<SyntheticJob> jobs = PlanSyntheticSet(dataset, AllOf(dataset), {1, 1, 1});
  engine::ModelDescription description;
  description.name = "fake";
  description.skeleton = dataset.skeleton;
  description.classes = dataset.classes;
  description.frame_rate_hz = dataset.frame_rate_hz;
  description.window_frames = dataset.LongestFrameCount();
  const FakeSynthesizer model(description);
  const absl::StatusOr<std::vector<dataset::Sequence>> answers =
      SynthesizeJobs(dataset, model, jobs);
  ASSERT_THAT(answers, IsOk());
  ASSERT_EQ(answers->size(), jobs.size());
  for (const dataset::Sequence& answer : *answers) {
    EXPECT_EQ(answer.pair.follower.frame_count(), answer.pair.leader.frame_count());
  }
  dataset.classes[0] = "shove";
  EXPECT_THAT(SynthesizeJobs(dataset, model, jobs),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("shove")));
}

// Two classes that any classifier tells apart: give steps back, flinch steps back four times as
// far. Each synthetic motion is labelled as the other class: what is learnt is what is taught.
TEST(RunHalfTest, TrainsEveryRowOnItsMaterial) {
  const dataset::Dataset dataset = MadeUpPairs(8);
  std::vector<AccuracyRow> rows;
  std::ostringstream progress;
  for (const uint64_t seed : {1, 2}) {
    DataHalf half;
    half.seed = seed;
    half.split = *SplitInHalves(dataset, seed);
    for (const int index : half.split.train) {
      half.synthetic.push_back(dataset.sequences[static_cast<size_t>(index)]);
      half.synthetic.back().interaction_class = 1 - half.synthetic.back().interaction_class;
    }
    ASSERT_THAT(RunHalf(dataset, half, {"with synthetic", 40, 1}, &progress, &rows), IsOk());
  }
  std::vector<std::string> names;
  for (const AccuracyRow& row : rows) {
    names.push_back(row.name);
    ASSERT_THAT(row.trials, SizeIs(2));
    ASSERT_THAT(row.trials.front(), SizeIs(3));
  }
  EXPECT_THAT(names, ElementsAre("captured", "with synthetic", "captured, longer",
                                 "with synthetic, longer", "synthetic alone"));
  EXPECT_GE(rows.front().trials.front().back(), 0.9);
  EXPECT_LE(rows.back().trials.front().back(), 0.1);
  const std::string lines = progress.str();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 10);
}

TEST(AccuracyTablesTest, HaveMeansDeviationsAndPairedGains) {
  const auto tables = AccuracyTables({"kick"}, {{"captured", {{0.5, 0.6}, {0.7, 0.8}, {0.9, 1.0}}},
                                                {"more", {{0.6, 0.5}, {0.7, 0.8}, {1.0, 0.7}}}});
  ASSERT_THAT(tables, SizeIs(3));
  EXPECT_THAT(tables[0].columns, ElementsAre("kick", "mean"));
  EXPECT_THAT(tables[0].rows[0].values, ElementsAre(DoubleEq(0.7), DoubleEq(0.8)));
  EXPECT_EQ(tables[0].best, report::Best::kHighest);
  EXPECT_THAT(tables[1].rows[0].values, ElementsAre(DoubleEq(0.2), DoubleEq(0.2)));
  ASSERT_THAT(tables[2].rows, SizeIs(3));
  EXPECT_EQ(tables[2].rows[0].name, "more");
  EXPECT_THAT(tables[2].rows[0].values,  // .1, 0, .1; -.1, 0, -.3
              ElementsAre(DoubleNear(0.2 / 3, 1e-12), DoubleNear(-0.4 / 3, 1e-12)));
  EXPECT_EQ(tables[2].rows[1].name, "more, deviation");
  EXPECT_THAT(tables[2].rows[2].values, ElementsAre(DoubleNear(2.0 / 3, 1e-12), 0));
}

}  // namespace
}  // namespace duet::evaluation::experiments
