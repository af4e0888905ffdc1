#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "model/evaluation/judge/judge.h"
#include "model/motion/vec3.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::judge {
namespace {

using test::MadeUpPairs;

constexpr int kPairsAClass = 12;

MotionClassifierOptions Small() {
  MotionClassifierOptions options;
  options.hidden = 12;
  options.epochs = 15;
  return options;
}

// The captured followers of subject "c", or of all others.
std::vector<metrics::ScoredMotion> Followers(const dataset::Dataset& dataset, bool of_c) {
  std::vector<int> chosen;
  for (size_t i = 0; i < dataset.sequences.size(); ++i) {
    if ((dataset.sequences[i].subjects.front() == "c") == of_c) {
      chosen.push_back(static_cast<int>(i));
    }
  }
  return metrics::CapturedMotions(dataset, chosen);
}

MotionClassifier Trained(const dataset::Dataset& dataset, const MotionClassifierOptions& options) {
  absl::StatusOr<MotionClassifier> judge =
      MotionClassifier::Train(dataset, Followers(dataset, false), options);
  EXPECT_TRUE(judge.ok()) << judge.status();
  return *std::move(judge);
}

TEST(MotionClassifier, ClassifiesAnUnseenSubject) {
  const dataset::Dataset dataset = MadeUpPairs(kPairsAClass);
  const MotionClassifier judge = Trained(dataset, Small());
  const std::vector<metrics::ScoredMotion> test = Followers(dataset, true);
  ASSERT_THAT(test, SizeIs(2 * kPairsAClass / 3));
  const std::vector<std::vector<float>> probabilities = judge.Judge(dataset, test).probabilities;
  ASSERT_THAT(probabilities, SizeIs(test.size()));
  int right = 0;
  for (size_t i = 0; i < test.size(); ++i) {
    ASSERT_THAT(probabilities[i], SizeIs(2));
    EXPECT_NEAR(probabilities[i][0] + probabilities[i][1], 1, 1e-5);
    const int asked = dataset.sequences[static_cast<size_t>(test[i].sequence)].interaction_class;
    right += probabilities[i][static_cast<size_t>(asked)] > 0.5f ? 1 : 0;
  }
  EXPECT_GE(right, static_cast<int>(test.size()) - 1);
}

TEST(MotionClassifier, IsDeterministic) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  MotionClassifierOptions options = Small();
  options.epochs = 2;
  const auto features = [&] {
    return Trained(dataset, options).Judge(dataset, Followers(dataset, true)).features;
  };
  const metrics::FeatureSet first = features();
  EXPECT_THAT(first.front(), SizeIs(2 * options.hidden));
  EXPECT_EQ(features(), first);
  options.seed = 1;
  EXPECT_NE(features(), first);
}

TEST(MotionClassifier, IsInvariantToThePlaceInTheWorld) {
  const dataset::Dataset dataset = MadeUpPairs(6);
  dataset::Dataset moved = dataset;
  for (dataset::Sequence& sequence : moved.sequences) {
    for (motion::Clip* clip : {&sequence.pair.leader, &sequence.pair.follower}) {
      for (motion::Vec3& p : clip->poses.all()) p = RotateY(p, 2.5) + motion::Vec3{4, 0, -3};
    }
  }
  const MotionClassifier judge = Trained(dataset, Small());
  const auto here = judge.Judge(dataset, Followers(dataset, true)).probabilities;
  const auto there = judge.Judge(moved, Followers(moved, true)).probabilities;
  for (size_t i = 0; i < here.size(); ++i) EXPECT_NEAR(here[i][0], there[i][0], 1e-3) << i;
}

TEST(MotionClassifier, RefusesAClassWithoutMotion) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  std::vector<metrics::ScoredMotion> motions = Followers(dataset, false);
  motions.erase(std::remove_if(motions.begin(), motions.end(),
                               [&](const metrics::ScoredMotion& motion) {
                                 const size_t i = static_cast<size_t>(motion.sequence);
                                 return dataset.sequences[i].interaction_class == 1;
                               }),
                motions.end());
  const absl::Status status = MotionClassifier::Train(dataset, motions, Small()).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("flinch"));
}

// A leader who moves otherwise changes what a classifier of both sees, and no other.
TEST(MotionClassifier, SeesTheLeaderOnlyIfAsked) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  dataset::Dataset raised = dataset;
  const size_t hand = static_cast<size_t>(dataset.skeleton.Find("right_hand"));
  for (dataset::Sequence& sequence : raised.sequences) {
    motion::Poses& leader = sequence.pair.leader.poses;
    for (int t = 0; t < leader.frame_count(); ++t) leader[t][hand].y += 1;
  }
  MotionClassifierOptions options = Small();
  options.epochs = 1;
  for (const Sees sees : {Sees::kFollower, Sees::kBoth}) {
    options.sees = sees;
    const MotionClassifier judge = Trained(dataset, options);
    const bool same = judge.Judge(dataset, Followers(dataset, true)).probabilities ==
                      judge.Judge(raised, Followers(raised, true)).probabilities;
    EXPECT_EQ(same, sees == Sees::kFollower);
  }
}

}  // namespace
}  // namespace duet::evaluation::judge
