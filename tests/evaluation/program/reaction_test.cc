#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "model/evaluation/program/measures.h"
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

using Answer = std::function<Poses(const dataset::Sequence&)>;

double Figure(const Answer& answer, const std::string& name) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  std::vector<ReactionPair> pairs;
  for (const dataset::Sequence& sequence : Flinches()) {
    pairs.push_back({static_cast<int>(pairs.size()), 1,
                     MeasureReaction(skeleton, sequence, sequence.pair.follower.poses),
                     MeasureReaction(skeleton, sequence, answer(sequence))});
  }
  for (const report::TableRow& row : ReactionTable("r", pairs).rows) {
    if (row.name == name) return row.values[0];
  }
  ADD_FAILURE() << name;
  return 0;
}

TEST(ReactionTest, CapturedFollowerReactsAsCaptured) {
  const auto captured = [](const dataset::Sequence& sequence) {
    return sequence.pair.follower.poses;
  };
  for (const char* name : {"amplitude, head", "amplitude, torso", "correlation"}) {
    EXPECT_NEAR(Figure(captured, name), 1, 1e-6) << name;
  }
  EXPECT_GE(Figure(captured, "head goes back"), 0.5);
}

TEST(ReactionTest, FollowerWhoStandsDoesNotReact) {
  const auto still = [](const dataset::Sequence& sequence) {
    Poses poses = sequence.pair.follower.poses;
    for (int t = 1; t < poses.frame_count(); ++t) {
      std::copy(poses[0].begin(), poses[0].end(), poses[t].begin());
    }
    return poses;
  };
  for (const char* name : {"amplitude, head", "torso goes back", "correlation"}) {
    EXPECT_NEAR(Figure(still, name), 0, 1e-6) << name;
  }
}

}  // namespace
}  // namespace duet::evaluation::program
