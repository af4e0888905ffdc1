#include "model/training/exchanged_leaders.h"

#include <gtest/gtest.h>

#include "tests/training/made_up_dataset.h"

namespace duet::training {
namespace {

// A pair that stands at `at`, the follower one metre in front; the leader walks by `step` a frame.
dataset::Sequence Pair(const motion::Skeleton& skeleton, motion::Vec3 at, motion::Vec3 step,
                       int interaction_class) {
  dataset::Sequence sequence;
  sequence.interaction_class = interaction_class;
  motion::Poses leader(40, skeleton.joint_count()), follower(40, skeleton.joint_count());
  for (int t = 0; t < 40; ++t) {
    for (int j = 0; j < skeleton.joint_count(); ++j) {
      leader.at(t, j) = at + step * static_cast<float>(t);
      follower.at(t, j) = at + motion::Vec3{0, 0, -1};
    }
    leader.at(t, skeleton.hips->left) += motion::Vec3{-0.1f, 0, 0};
    leader.at(t, skeleton.hips->right) += motion::Vec3{0.1f, 0, 0};
  }
  sequence.pair.leader = {skeleton.joint_names, 30, leader};
  sequence.pair.follower = {skeleton.joint_names, 30, follower};
  return sequence;
}

TEST(ExchangedLeaders, TheFollowerKeepsItsDistanceFromTheNewLeadersPath) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const dataset::Sequence own = Pair(skeleton, {0, 1, 0}, {0, 0, 0}, 0);
  const dataset::Sequence other = Pair(skeleton, {5, 1, 2}, {0.01f, 0, 0}, 1);
  const dataset::Sequence exchanged = WithLeaderOf(skeleton, other, own);
  EXPECT_EQ(exchanged.interaction_class, 0);
  EXPECT_EQ(exchanged.pair.leader.poses, other.pair.leader.poses);
  for (int t = 15; t < 25; ++t) {  // away from the ends, which the smoothing bends
    const motion::Vec3 wanted = other.pair.leader.at(t, skeleton.root) + motion::Vec3{0, 0, -1};
    EXPECT_LT(Distance(exchanged.pair.follower.at(t, skeleton.root), wanted), 0.01f) << t;
  }
}

TEST(ExchangedLeaders, EqualLabelsAreCountedByFrame) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  dataset::Sequence a = Pair(skeleton, {}, {}, 0), b = a;
  EXPECT_EQ(EqualLabels(a, b), 1);
  b.interaction_class = 1;
  EXPECT_EQ(EqualLabels(a, b), 0);
  a.labels = {{0, 0, 40}, {1, 30, 40}};
  b.labels = {{0, 0, 40}};
  EXPECT_EQ(EqualLabels(a, b), 0.75);
}

TEST(ExchangedLeaders, OnlyLeadersWithOtherLabelsAreExchanged) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  std::vector<dataset::Sequence> sequences;
  for (int i = 0; i < 6; ++i) {
    sequences.push_back(Pair(skeleton, {static_cast<float>(i), 1, 0}, {}, i == 0 ? 1 : 0));
  }
  base::Random random(3);
  std::vector<dataset::Sequence> never = sequences;
  ExchangeLeaders(skeleton, 0, &random, &never);
  for (int i = 0; i < 6; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_EQ(never[at].pair.leader.poses, sequences[at].pair.leader.poses);
  }
  std::vector<dataset::Sequence> always = sequences;
  ExchangeLeaders(skeleton, 1, &random, &always);
  EXPECT_NE(always[0].pair.leader.poses, sequences[0].pair.leader.poses);
  for (std::size_t i = 1; i < 6; ++i) {
    const bool kept = always[i].pair.leader.poses == sequences[i].pair.leader.poses;
    EXPECT_TRUE(kept || always[i].pair.leader.poses == sequences[0].pair.leader.poses) << i;
  }
}

}  // namespace
}  // namespace duet::training
