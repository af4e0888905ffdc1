#include "client/batch/leader_sharing.h"

#include <memory>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {
namespace {

constexpr formats::Side kLeft = formats::Side::kLeft;

TEST(LastLeaders, AreSharedByItemsThatReadTheSameMotion) {
  const auto entry = [](const char* file, const char* start = "") {
    LeaderEntry made;
    made.file = file;
    made.follower_start = start;
    return std::make_shared<const LeaderEntry>(made);
  };
  const formats::Side left = formats::Side::kLeft, right = formats::Side::kRight;
  LastLeaders leaders(2);
  const auto first = leaders.Get(entry("a"), left, 0);
  EXPECT_EQ(leaders.Get(entry("a"), left, 0), first);
  // Each skeleton has its own last leader.
  const auto other_skeleton = leaders.Get(entry("a"), left, 1);
  EXPECT_NE(other_skeleton, first);
  EXPECT_EQ(leaders.Get(entry("a"), left, 0), first);
  EXPECT_EQ(leaders.Get(entry("a"), left, 1), other_skeleton);
  EXPECT_NE(leaders.Get(entry("a"), right, 0), first);
  const auto started = leaders.Get(entry("a", "start.csv"), left, 0);
  EXPECT_NE(started, first);
  EXPECT_NE(leaders.Get(entry("a", "0,0,1"), left, 0), started);
  LeaderEntry sided;
  sided.file = "a";
  sided.follower_start = "0,0,1";
  sided.follower_start_side = right;
  const auto with_side = leaders.Get(std::make_shared<const LeaderEntry>(sided), left, 0);
  EXPECT_NE(with_side, leaders.Get(entry("a", "0,0,1"), left, 0));
  EXPECT_NE(leaders.Get(entry("b"), left, 0), with_side);
}

// A leader of `frames` frames with the joints of SBU.
motion::Clip ClipOf(int frames) {
  motion::Clip clip;
  clip.joint_names = motion::SbuSkeleton().joint_names;
  clip.poses = motion::Poses(frames, static_cast<int>(clip.joint_names.size()));
  return clip;
}

std::shared_ptr<const LeaderEntry> EntryOf(const char* file) {
  LeaderEntry entry;
  entry.file = file;
  return std::make_shared<const LeaderEntry>(entry);
}

TEST(KeptLeaders, HoldOnlyTheFirstLeadersThatFitIntoTheMemory) {
  KeptLeaders kept(size_t{10} << 10);
  const auto a = EntryOf("a"), b = EntryOf("b"), c = EntryOf("c");
  for (const auto& entry : {a, b, c}) {
    kept.Keep(*entry, kLeft, 0, ClipOf(15), std::make_shared<SharedLeader>(entry, kLeft));
  }
  EXPECT_NE(kept.Take(*a, kLeft, 0), nullptr);
  EXPECT_NE(kept.Take(*b, kLeft, 0), nullptr);
  EXPECT_EQ(kept.Take(*c, kLeft, 0), nullptr);
}

TEST(KeptLeaders, AreKnownBySideStartAndSkeleton) {
  KeptLeaders kept(size_t{1} << 20);
  const auto entry = EntryOf("a");
  const auto leader = std::make_shared<SharedLeader>(entry, kLeft);
  kept.Keep(*entry, kLeft, 0, ClipOf(2), leader);
  LeaderEntry started = *entry;
  started.follower_start = "0,0,1";
  EXPECT_EQ(kept.Take(started, kLeft, 0), nullptr);
  EXPECT_EQ(kept.Take(*entry, formats::Side::kRight, 0), nullptr);
  EXPECT_EQ(kept.Take(*entry, kLeft, 1), nullptr);
  EXPECT_EQ(kept.Take(*entry, kLeft, 0), leader);
}

TEST(LastLeaders, TakeKeptLeadersInsteadOfNewOnes) {
  KeptLeaders kept(size_t{1} << 20);
  const auto entry = EntryOf("a");
  const auto leader = std::make_shared<SharedLeader>(entry, kLeft);
  kept.Keep(*entry, kLeft, 0, ClipOf(2), leader);
  LastLeaders leaders(1, &kept);
  EXPECT_EQ(leaders.Get(entry, kLeft, 0), leader);
  EXPECT_EQ(leaders.Get(entry, kLeft, 0), leader);
}

}  // namespace
}  // namespace duet::client::batch
