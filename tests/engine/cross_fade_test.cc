#include "model/engine/cross_fade.h"

#include <algorithm>

#include "gtest/gtest.h"
#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

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

TEST(CrossFade, EqualMotionsDoNotChange) {
  Pair pair;
  pair.to = pair.from;
  const motion::Poses blended = Blended(pair);
  for (std::size_t i = 0; i < blended.all().size(); ++i) {
    ASSERT_LT(Distance(blended.all()[i], pair.from.all()[i]), 1e-6f) << i;
  }
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

TEST(CrossFade, TakesBonesInAnyOrder) {
  motion::Skeleton reversed = motion::SbuSkeleton();
  std::reverse(reversed.bones.begin(), reversed.bones.end());
  const Pair pair;
  motion::Poses blended = pair.from;
  CrossFade(reversed).Blend(pair.to, 0, &blended);
  EXPECT_EQ(blended, Blended(pair));
}

TEST(CrossFade, NoSharedFramesChangeNothing) {
  Pair pair;
  const motion::Poses before = pair.from;
  CrossFade(motion::SbuSkeleton()).Blend(pair.to, kFadedFrames, &pair.from);
  EXPECT_EQ(pair.from, before);
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

}  // namespace
}  // namespace duet::engine
