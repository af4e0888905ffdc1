#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "model/evaluation/program/experiment.h"
#include "tests/evaluation/support/made_up_pairs.h"

namespace duet::evaluation::program {
namespace {

using motion::Poses;

// The sequences that step back by twice of what the leader's hand rises.
std::vector<dataset::Sequence> Flinches() {
  std::vector<dataset::Sequence> flinches;
  for (dataset::Sequence& sequence : test::MadeUpPairs(4).sequences) {
    if (sequence.interaction_class == 1) flinches.push_back(std::move(sequence));
  }
  return flinches;
}

Poses Captured(const dataset::Sequence& sequence) { return sequence.pair.follower.poses; }

Poses Standing(const dataset::Sequence& sequence) {
  Poses poses = sequence.pair.follower.poses;
  for (int t = 1; t < poses.frame_count(); ++t) {
    std::copy(poses[0].begin(), poses[0].end(), poses[t].begin());
  }
  return poses;
}

using Answer = std::function<Poses(const dataset::Sequence&)>;

// Of answers to the leaders as captured, or to padded ones, who are answered by somebody who
// stands.
double Figure(const Answer& answer, const std::string& name, bool padded = false) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  std::vector<ReactionPair> pairs;
  for (const dataset::Sequence& sequence : Flinches()) {
    pairs.push_back({static_cast<int>(pairs.size()), 1,
                     MeasureReaction(skeleton, sequence, sequence.pair.follower.poses),
                     MeasureReaction(skeleton, sequence, answer(sequence)),
                     MeasureReaction(skeleton, sequence, Standing(sequence))});
  }
  for (const report::TableRow& row : ReactionTable("r", pairs).rows) {
    if (row.name == name) return row.values[padded ? 3 : 0];
  }
  ADD_FAILURE() << name;
  return 0;
}

TEST(ReactionTest, CapturedFollowerReactsAsCaptured) {
  for (const char* name : {"amplitude, head", "amplitude, torso", "correlation"}) {
    EXPECT_NEAR(Figure(Captured, name), 1, 1e-6) << name;
  }
  EXPECT_GE(Figure(Captured, "head goes back"), 0.5);
}

TEST(ReactionTest, FollowerWhoStandsDoesNotReact) {
  for (const char* name : {"amplitude, head", "torso goes back", "correlation"}) {
    EXPECT_NEAR(Figure(Standing, name), 0, 1e-6) << name;
    EXPECT_NEAR(Figure(Captured, name, true), 0, 1e-6) << name;
  }
}

TEST(ReactionTest, PaddingHoldsBothPeopleStill) {
  dataset::Sequence padded = Flinches()[0];
  const motion::Clip before = padded.pair.leader;
  const int frames = PadSequence(&padded);
  EXPECT_EQ(frames, std::lround(before.frame_rate_hz));
  for (const motion::Clip* clip : {&padded.pair.leader, &padded.pair.follower}) {
    EXPECT_EQ(clip->frame_count(), before.frame_count() + 2 * frames);
    EXPECT_EQ(clip->poses[0], clip->poses[frames]);
    EXPECT_EQ(clip->poses[clip->frame_count() - 1], clip->poses[clip->frame_count() - 1 - frames]);
  }
  EXPECT_EQ(padded.pair.leader.poses[frames + 1], before.poses[1]);
}

}  // namespace
}  // namespace duet::evaluation::program
