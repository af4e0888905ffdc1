#include "model/evaluation/experiments/live_reaction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/evaluation/experiments/answers.h"
#include "model/motion/skeleton.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/sample_motion.h"
#include "tests/support/status_matchers.h"

namespace duet::evaluation::experiments {
namespace {

using test::IsOk;

// One leader who walks away at 1 m/s.
dataset::Dataset WalkingPair() {
  dataset::Dataset dataset = test::MadeUpPairs(1);
  dataset.skeleton = motion::SbuSkeleton();
  dataset.sequences.resize(1);
  dataset::Sequence& sequence = dataset.sequences[0];
  sequence.pair.leader = {motion::SbuSkeleton().joint_names, 15, test::SwayingMotion(30, 15)};
  motion::Poses& poses = sequence.pair.leader.poses;
  for (int t = 1; t < poses.frame_count(); ++t) {
    for (int j = 0; j < poses.joint_count(); ++j) {
      poses.at(t, j) = poses.at(0, j) + motion::Vec3{0, 0, static_cast<float>(t) / 15};
    }
  }
  sequence.pair.follower = sequence.pair.leader;
  return dataset;
}

// Answers with the leader itself.
test::FakeSynthesizer Mirror(const dataset::Dataset& dataset) {
  engine::ModelDescription description = test::SamplingDescription();
  description.classes = dataset.classes;
  test::FakeSynthesizer model(description);
  model.answer = [](motion::Vec3 leader, absl::Span<const float> labels) {
    return leader + motion::Vec3{0, labels[1], 0};
  };
  return model;
}

TEST(LiveReactionTest, AFollowerThatMirrorsTheLeaderReactsAtOnceAndADelayDoesNotChangeThat) {
  const dataset::Dataset dataset = WalkingPair();
  const test::FakeSynthesizer model = Mirror(dataset);
  for (const int delay : {0, 5}) {
    const auto figures = MeasureLiveReaction(model, dataset, {0}, 0, delay);
    ASSERT_THAT(figures, IsOk());
    ASSERT_EQ(figures->reaction_seconds.size(), 1u);
    // Plans are made every second frame.
    EXPECT_LE(std::abs(figures->reaction_seconds[0]), 0.1) << delay;
    ASSERT_EQ(figures->label_seconds.size(), 1u);
    EXPECT_LE(std::abs(figures->label_seconds[0]), 0.1) << delay;
    EXPECT_EQ(figures->clips, 1);
    EXPECT_GT(figures->speed, 0.2);
  }
}

TEST(LiveReactionTest, CapturedFollowersWhoMoveWithTheirLeadersReactAtOnce) {
  const std::vector<double> seconds = CapturedReactions(WalkingPair(), {0});
  ASSERT_EQ(seconds.size(), 1u);
  EXPECT_EQ(seconds[0], 0);
}

TEST(LiveAnswersTest, ModelsThatDoNotContinueSettledFramesAreRefused) {
  const dataset::Dataset dataset = WalkingPair();
  engine::ModelDescription description = test::FakeDescription();
  description.classes = dataset.classes;
  const test::FakeSynthesizer model(description);
  EXPECT_TRUE(absl::IsFailedPrecondition(
      MeasureLiveReaction(model, dataset, {0}, 0, /*live_delay=*/0).status()));
}

}  // namespace
}  // namespace duet::evaluation::experiments
