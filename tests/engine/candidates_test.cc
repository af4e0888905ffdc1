#include "model/engine/candidates.h"

#include <set>

#include "gmock/gmock.h"
#include "tests/support/bodies.h"

namespace duet::engine {
namespace {

using motion::Vec3;
using test::Changed;
using test::kFrames;
using test::kRate;
using test::Puppet;

motion::Poses Away(float x, float z) {
  return Changed(Puppet(), [x, z](int, Vec3 joint) { return joint + Vec3{x, 0, z}; });
}

int Best(const std::vector<motion::Poses>& followers, int settled = 0) {
  return CandidateJudge(motion::SbuSkeleton()).Best(Puppet(), followers, settled, kRate);
}

TEST(CandidateJudge, LeavesOutFaults) {
  motion::Poses twisted = Away(0, 1);
  for (int t = 0; t < kFrames; ++t) std::swap(twisted.at(t, 9), twisted.at(t, 12));
  EXPECT_EQ(Best({twisted, Away(0, 1)}), 1);
  EXPECT_EQ(Best({Away(0.02f, 0), Away(0, 1)}), 1);  // inside the leader
  EXPECT_EQ(Best({Away(0, 1), twisted}), 0);
}

TEST(CandidateJudge, TheFirstOfEquals) { EXPECT_EQ(Best({Away(0, 1), Away(1, 1)}), 0); }

TEST(CandidateJudge, HandsThatAreToMeetDo) {
  const motion::Poses leader = Puppet([](double, test::PuppetPose* pose) {
    pose->right_hand.target = {-0.15, 0, 0.7};
  });
  // The right hand of the second one is at the leader's.
  std::vector<motion::Poses> followers = {Away(0, 1), Away(0, 1)};
  for (int t = 0; t < kFrames; ++t) followers[1].at(t, 8) = leader.at(t, 8);
  const CandidateJudge judge(motion::SbuSkeleton());
  EXPECT_EQ(judge.Best(leader, followers, 0, kRate), 0);
  const solver::ContactRules rules(kFrames, {0, 1, 0.1f});
  EXPECT_EQ(judge.Best(leader, followers, 0, kRate, {}, rules), 1);
  EXPECT_EQ(judge.Best(leader, followers, kFrames, kRate, {}, rules), 0);
}

// A critic that finds followers the more captured the higher their joints are.
Critic LikesHeight(float factor) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const std::size_t inputs = static_cast<std::size_t>(CriticInputs(skeleton, 1));
  const auto zeros = [](std::size_t count) { return std::vector<float>(count); };
  CriticWeights weights = {zeros(kCriticUnits * inputs),
                           zeros(kCriticUnits),
                           zeros(kCriticUnits * kCriticUnits * kCriticKernel),
                           zeros(kCriticUnits),
                           zeros(kCriticUnits * kCriticUnits * kCriticKernel),
                           zeros(kCriticUnits),
                           zeros(kCriticUnits),
                           zeros(1)};
  weights.frames_weight[1] = 1;  // the first joint's height above the leader's root
  weights.output_weight[0] = factor;
  return {skeleton, kRate, std::move(weights)};
}

TEST(CandidateJudge, TheCriticDecidesBetweenFaultlessSamples) {
  const motion::Poses low = Away(0, 1);
  motion::Poses high = low;
  for (motion::Vec3& joint : high.all()) joint.y += 0.1f;
  const std::vector<float> labels(kFrames, 1);
  const auto best = [&](float factor, const motion::Poses& other) {
    return CandidateJudge(motion::SbuSkeleton(), LikesHeight(factor))
        .Best(Puppet(), {low, other}, 0, kRate, {}, {}, labels);
  };
  EXPECT_EQ(best(1, high), 1);
  EXPECT_EQ(best(-1, high), 0);
  // An obvious fault weighs more than the critic's opinion.
  for (int t = 0; t < kFrames; ++t) std::swap(high.at(t, 9), high.at(t, 12));
  EXPECT_EQ(best(1, high), 0);
}

TEST(CandidateJudge, JudgesNothingInSettledFrames) {
  motion::Poses late = Away(0, 1);
  for (int t = 0; t < 10; ++t) std::swap(late.at(t, 9), late.at(t, 12));
  EXPECT_EQ(Best({late, Away(0, 1)}, 10), 0);
  EXPECT_EQ(Best({late, Away(0, 1)}, 0), 1);
}

TEST(CandidateJudge, ASkeletonWithoutLandmarksIsNotJudged) {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  skeleton.hips.reset();
  EXPECT_EQ(CandidateJudge(skeleton).Best(Puppet(), {Away(0, 0), Away(0, 1)}, 0, kRate), 0);
}

TEST(CandidateSeed, TheFirstIsTheRequestsAndAllDiffer) {
  EXPECT_EQ(CandidateSeed(42, 0), 42u);
  std::set<uint64_t> seeds;
  for (uint64_t seed = 0; seed < 50; ++seed) {
    for (int n = 0; n < 16; ++n) seeds.insert(CandidateSeed(seed, n));
  }
  EXPECT_EQ(seeds.size(), 800u);
}

}  // namespace
}  // namespace duet::engine
