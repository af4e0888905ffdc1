#include "model/engine/cross_fade.h"

#include <algorithm>

#include "gtest/gtest.h"
#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

using test::SwayingMotion;

constexpr int kJoints = 15;
constexpr int kFrames = 12;

const motion::Vec3& At(const std::vector<motion::Vec3>& motion, int frame, int joint) {
  return motion[static_cast<std::size_t>(frame * kJoints + joint)];
}

// A motion and another one that is turned by a quarter and moved.
struct Pair {
  std::vector<motion::Vec3> from = SwayingMotion(kFrames, 15);
  std::vector<motion::Vec3> to = from;
  Pair() {
    for (motion::Vec3& p : to) p = RotateY(p, 1.5) + motion::Vec3{0.3f, 0, 0.1f};
  }
};

std::vector<motion::Vec3> Blended(const Pair& pair) {
  std::vector<motion::Vec3> blended = pair.from;
  CrossFade(motion::SbuSkeleton()).Blend(blended.data(), pair.to.data(), kFrames);
  return blended;
}

TEST(CrossFade, LeavesEqualMotionsAlone) {
  Pair pair;
  pair.to = pair.from;
  const std::vector<motion::Vec3> blended = Blended(pair);
  for (std::size_t i = 0; i < blended.size(); ++i) {
    ASSERT_LT(Distance(blended[i], pair.from[i]), 1e-6f) << i;
  }
}

TEST(CrossFade, GoesSmoothlyFromOneToTheOther) {
  const Pair pair;
  const std::vector<motion::Vec3> blended = Blended(pair);
  const int root = motion::SbuSkeleton().root;
  float previous = 0, steepest = 0;
  for (int t = 0; t < kFrames; ++t) {
    const motion::Vec3 from = At(pair.from, t, root), to = At(pair.to, t, root);
    const float weight = Distance(At(blended, t, root), from) / Distance(to, from);
    EXPECT_GT(weight, previous) << t;
    EXPECT_LT(weight, 1) << t;
    steepest = std::max(steepest, weight - previous);
    previous = weight;
  }
  // Level at both ends: its first and last steps are far smaller than those in the middle.
  const motion::Vec3 from = At(pair.from, 0, root), to = At(pair.to, 0, root);
  EXPECT_LT(Distance(At(blended, 0, root), from) / Distance(to, from), steepest / 4);
  EXPECT_LT(1 - previous, steepest / 4);
}

TEST(CrossFade, KeepsLimbLengths) {
  const Pair pair;
  const std::vector<motion::Vec3> blended = Blended(pair);
  for (int t = 0; t < kFrames; ++t) {
    for (const motion::Bone& bone : motion::SbuSkeleton().bones) {
      // Both motions have the same limbs here, in other directions.
      const float wanted = Distance(At(pair.from, t, bone.parent), At(pair.from, t, bone.child));
      const float got = Distance(At(blended, t, bone.parent), At(blended, t, bone.child));
      EXPECT_NEAR(got, wanted, 1e-5f) << "frame " << t << ", joint " << bone.child;
    }
  }
}

TEST(CrossFade, OppositeLimbsStayFinite) {
  // Half-way through, every bone's two directions cancel exactly.
  std::vector<motion::Vec3> from(SwayingMotion(1, 15)), to;
  const motion::Vec3 root = from[static_cast<std::size_t>(motion::SbuSkeleton().root)];
  for (motion::Vec3& p : from) {
    p -= root;
    to.push_back(-p);
  }
  CrossFade(motion::SbuSkeleton()).Blend(from.data(), to.data(), 1);
  for (const motion::Vec3& p : from) ASSERT_TRUE(IsFinite(p));
}

TEST(CrossFade, TakesBonesInAnyOrder) {
  motion::Skeleton reversed = motion::SbuSkeleton();
  std::reverse(reversed.bones.begin(), reversed.bones.end());
  const Pair pair;
  std::vector<motion::Vec3> blended = pair.from;
  CrossFade(reversed).Blend(blended.data(), pair.to.data(), kFrames);
  EXPECT_EQ(blended, Blended(pair));
}

TEST(CrossFade, NoSharedFramesChangeNothing) {
  Pair pair;
  const std::vector<motion::Vec3> before = pair.from;
  CrossFade(motion::SbuSkeleton()).Blend(pair.from.data(), pair.to.data(), 0);
  EXPECT_EQ(pair.from, before);
}

}  // namespace
}  // namespace duet::engine
