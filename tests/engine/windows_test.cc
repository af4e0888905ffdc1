#include "model/engine/windows.h"

#include <algorithm>
#include <limits>
#include <set>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

using ::testing::ElementsAre;

TEST(WindowPlan, ShortClipIsOneWindowOfItsOwnLength) {
  for (int frames : {2, 3, 45, 46}) {
    const WindowPlan plan = PlanWindows(frames, 46, CrossFadeOverlap(46));
    EXPECT_EQ(plan.length, frames);
    EXPECT_THAT(plan.starts, ElementsAre(0));
  }
}

TEST(WindowPlan, SpreadsEvenly) {
  // 10 s at 15 Hz: 151 frames, the last start at 105, which 4 steps of at most 31 reach.
  EXPECT_THAT(PlanWindows(151, 46, CrossFadeOverlap(46)).starts, ElementsAre(0, 26, 53, 79, 105));
}

void ExpectCovered(int frames, int longest, int overlap) {
  const WindowPlan plan = PlanWindows(frames, longest, overlap);
  ASSERT_EQ(plan.length, longest);
  ASSERT_EQ(plan.starts.front(), 0);
  ASSERT_EQ(plan.starts.back() + longest, frames);
  int narrowest = longest, widest = 0;
  for (std::size_t k = 1; k < plan.starts.size(); ++k) {
    const int step = plan.starts[k] - plan.starts[k - 1];
    narrowest = std::min(narrowest, step);
    widest = std::max(widest, step);
  }
  ASSERT_GE(narrowest, 1) << frames << " frames by " << longest;
  ASSERT_LE(widest, longest - overlap) << frames << " frames by " << longest;
  ASSERT_LE(widest - narrowest, 1) << frames << " frames by " << longest;
}

TEST(WindowPlan, CoversEveryFrameWithOverlap) {
  for (int longest : {2, 3, 4, 5, 7, 46, 104}) {
    for (int frames = longest + 1; frames < 20 * longest; ++frames) {
      ASSERT_NO_FATAL_FAILURE(ExpectCovered(frames, longest, CrossFadeOverlap(longest)));
      ASSERT_NO_FATAL_FAILURE(ExpectCovered(frames, longest, SettledOverlap(longest)));
    }
  }
}

TEST(WindowPlan, SharesAThirdToCrossFadeAndASixthToGoOn) {
  EXPECT_EQ(CrossFadeOverlap(46), 15);
  EXPECT_EQ(CrossFadeOverlap(104), 34);
  EXPECT_EQ(CrossFadeOverlap(2), 1);
  EXPECT_EQ(SettledOverlap(46), 8);
  EXPECT_EQ(SettledOverlap(104), 17);
  EXPECT_EQ(SettledOverlap(2), 1);
}

TEST(WindowPlan, UsesNoMoreWindowsThanNeeded) {
  for (int frames = 47; frames < 2000; ++frames) {
    const int needed = (frames - 15 + 30) / 31;  // each adds at most 46 - 15 frames
    ASSERT_EQ(static_cast<int>(PlanWindows(frames, 46, CrossFadeOverlap(46)).starts.size()), needed)
        << frames;
  }
}

using test::SwayingMotion;

constexpr int kFadedFrames = 12;

// A motion and another one that is turned by a quarter and moved.
struct Pair {
  motion::Poses from = SwayingMotion(kFadedFrames, 15);
  motion::Poses to = from;
  Pair() {
    for (motion::Vec3& p : to.all()) p = RotateY(p, 1.5) + motion::Vec3{0.3f, 0, 0.1f};
  }
};

motion::Poses Blended(const Pair& pair) {
  motion::Poses blended = pair.from;
  CrossFade(motion::SbuSkeleton()).Blend(pair.to, 0, &blended);
  return blended;
}

TEST(CrossFade, GoesSmoothlyFromOneToTheOther) {
  const Pair pair;
  const motion::Poses blended = Blended(pair);
  const int root = motion::SbuSkeleton().root;
  float previous = 0, steepest = 0;
  for (int t = 0; t < kFadedFrames; ++t) {
    const motion::Vec3 from = pair.from.at(t, root), to = pair.to.at(t, root);
    const float weight = Distance(blended.at(t, root), from) / Distance(to, from);
    EXPECT_GT(weight, previous) << t;
    EXPECT_LT(weight, 1) << t;
    steepest = std::max(steepest, weight - previous);
    previous = weight;
  }
  // Level at both ends: its first and last steps are far smaller than those in the middle.
  const motion::Vec3 from = pair.from.at(0, root), to = pair.to.at(0, root);
  EXPECT_LT(Distance(blended.at(0, root), from) / Distance(to, from), steepest / 4);
  EXPECT_LT(1 - previous, steepest / 4);
}

TEST(CrossFade, KeepsLimbLengths) {
  const Pair pair;
  const motion::Poses blended = Blended(pair);
  for (int t = 0; t < kFadedFrames; ++t) {
    for (const motion::Bone& bone : motion::SbuSkeleton().bones) {
      // Both motions have the same limbs here, in other directions.
      const float wanted = Distance(pair.from.at(t, bone.parent), pair.from.at(t, bone.child));
      const float got = Distance(blended.at(t, bone.parent), blended.at(t, bone.child));
      EXPECT_NEAR(got, wanted, 1e-5f) << "frame " << t << ", joint " << bone.child;
    }
  }
}

TEST(CrossFade, OppositeLimbsStayFinite) {
  // Half-way through, every bone's two directions cancel exactly.
  motion::Poses from = SwayingMotion(1, 15);
  const motion::Vec3 root = from.at(0, motion::SbuSkeleton().root);
  for (motion::Vec3& p : from.all()) p -= root;
  motion::Poses to = from;
  for (motion::Vec3& p : to.all()) p = -p;
  CrossFade(motion::SbuSkeleton()).Blend(to, 0, &from);
  for (const motion::Vec3& p : from.all()) ASSERT_TRUE(IsFinite(p));
}

TEST(CrossFade, LeavesTheFramesBeforeTheSharedOnes) {
  const Pair pair;
  motion::Poses blended = SwayingMotion(3, 15);
  blended.Append(pair.from.all());
  const motion::Poses before = blended;
  CrossFade(motion::SbuSkeleton()).Blend(pair.to, 3, &blended);
  for (int t = 0; t < 3; ++t) EXPECT_EQ(blended[t], before[t]) << t;
  for (int t = 0; t < kFadedFrames; ++t) EXPECT_EQ(blended[3 + t], Blended(pair)[t]) << t;
}

TEST(WindowSeed, TheFirstWindowHasTheRequestsOwn) {
  for (uint64_t seed : {uint64_t{0}, uint64_t{7}, std::numeric_limits<uint64_t>::max()}) {
    EXPECT_EQ(WindowSeed(seed, 0), seed);
  }
}

TEST(WindowSeed, LaterWindowsFollowThePublishedStream) {
  // The first numbers of SplitMix64 that begins at 1234567, as published with its reference code.
  EXPECT_EQ(WindowSeed(1234567, 1), 6457827717110365317u);
  EXPECT_EQ(WindowSeed(1234567, 2), 3203168211198807973u);
  EXPECT_EQ(WindowSeed(1234567, 3), 9817491932198370423u);
}

TEST(WindowSeed, NoTwoWindowsOfNeighbouringSeedsShareOne) {
  std::set<uint64_t> seeds;
  for (uint64_t seed = 0; seed < 100; ++seed) {
    for (int window = 0; window < 300; ++window) seeds.insert(WindowSeed(seed, window));
  }
  EXPECT_EQ(seeds.size(), 100u * 300u);
}

TEST(LeaderSeed, DiffersBetweenLeadersAndNotBetweenPlaces) {
  motion::Poses leader(30, 2);
  for (int t = 0; t < 30; ++t) leader.at(t, 1) = {0.1f * static_cast<float>(t), 1.03f, 0};
  const uint64_t seed = LeaderSeed(leader, 15, {});
  EXPECT_LT(seed, uint64_t{1} << 32);
  motion::Poses turned = leader;
  for (motion::Vec3& joint : turned.all()) joint = RotateY(joint, 1) + motion::Vec3{3, 0, -2};
  EXPECT_EQ(LeaderSeed(turned, 15, {}), seed);
  motion::Poses faster = leader;
  for (motion::Vec3& joint : faster.all()) joint.x *= 1.1f;
  EXPECT_NE(LeaderSeed(faster, 15, {}), seed);
  EXPECT_NE(LeaderSeed(leader, 12, {}), seed) << "the clip is longer";
  EXPECT_THAT((std::vector<uint64_t>{5, 7}), testing::Contains(LeaderSeed(leader, 15, {5, 7})));
  EXPECT_EQ(LeaderSeed(leader, 15, {7}), 7u);
}

}  // namespace
}  // namespace duet::engine
