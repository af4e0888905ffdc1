#include "model/evaluation/experiments/reaction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/evaluation/support/made_up_pairs.h"

namespace duet::evaluation::experiments {
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

// A follower in a sequence that is padded or not, and the frames of padding.
using Answer = std::function<Poses(const dataset::Sequence&)>;

std::vector<report::Table> Measured(const Answer& answer) {
  const ReactionMeter meter(motion::SbuSkeleton());
  EXPECT_TRUE(meter.possible());
  std::vector<ReactionPair> pairs;
  for (const dataset::Sequence& sequence : Flinches()) {
    dataset::Sequence padded = sequence;
    const int padding = PadSequence(&padded);
    EXPECT_EQ(padding, 15);
    pairs.push_back({static_cast<int>(pairs.size()), 1, meter.Captured(sequence),
                     meter.Measure(sequence, answer(sequence), 0),
                     meter.Measure(sequence, answer(padded), padding)});
  }
  return ReactionTables("r", {"give", "flinch"}, pairs);
}

// The figure without and with padding.
std::pair<double, double> Figure(const std::vector<report::Table>& tables,
                                 const std::string& name) {
  for (const report::TableRow& row : tables.front().rows) {
    if (row.name == name) return {row.values[0], row.values[3]};
  }
  ADD_FAILURE() << name;
  return {};
}

TEST(ReactionTest, CapturedFollowerReactsAsCaptured) {
  const auto tables =
      Measured([](const dataset::Sequence& sequence) { return sequence.pair.follower.poses; });
  for (const char* name : {"amplitude, head", "amplitude, torso", "correlation"}) {
    const auto [plain, padded] = Figure(tables, name);
    EXPECT_NEAR(plain, 1, 1e-6) << name;
    EXPECT_NEAR(padded, 1, 0.15) << name;
  }
  EXPECT_GE(Figure(tables, "head goes back").first, 0.5);
  ASSERT_EQ(tables[1].rows.size(), 1u);
  EXPECT_EQ(tables[1].rows[0].name, "flinch");
  EXPECT_EQ(tables[1].rows[0].values.size(), tables[1].columns.size());
}

TEST(ReactionTest, FollowerWhoStandsDoesNotReact) {
  const auto tables = Measured([](const dataset::Sequence& sequence) {
    Poses poses = sequence.pair.follower.poses;
    for (int t = 1; t < poses.frame_count(); ++t) {
      std::copy(poses[0].begin(), poses[0].end(), poses[t].begin());
    }
    return poses;
  });
  for (const char* name : {"amplitude, head", "torso goes back", "correlation"}) {
    EXPECT_NEAR(Figure(tables, name).first, 0, 1e-6) << name;
  }
}

TEST(ReactionTest, FollowerWhoTakesTheClipForAClockFailsWithPadding) {
  // Stretches the captured reaction over whatever length the leader has.
  const auto tables = Measured([](const dataset::Sequence& sequence) {
    const int frames = sequence.pair.leader.frame_count();
    for (const dataset::Sequence& captured : Flinches()) {
      if (captured.id != sequence.id) continue;
      const Poses& follower = captured.pair.follower.poses;
      Poses poses(0, follower.joint_count());
      for (int t = 0; t < frames; ++t) poses.Append(follower[t * follower.frame_count() / frames]);
      return poses;
    }
    return Poses();
  });
  const auto [plain, padded] = Figure(tables, "amplitude, torso");
  EXPECT_NEAR(plain, 1, 1e-6);
  EXPECT_LT(padded, 0.5);
}

}  // namespace
}  // namespace duet::evaluation::experiments
