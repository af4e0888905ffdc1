#include "model/motion/capsules.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "gtest/gtest.h"

namespace duet::motion {
namespace {

TEST(SegmentDistanceTest, AgreesWithAFineGrid) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto point = [&] { return Vec3{uniform(random), uniform(random), uniform(random)}; };
  constexpr int kSteps = 100;
  for (int trial = 0; trial < 30; ++trial) {
    const Vec3 a0 = point(), a1 = point(), b0 = point(), b1 = point();
    double best = 10;
    for (int s = 0; s <= kSteps; ++s) {
      for (int t = 0; t <= kSteps; ++t) {
        best = std::min<double>(best, Distance(Lerp(a0, a1, static_cast<float>(s) / kSteps),
                                               Lerp(b0, b1, static_cast<float>(t) / kSteps)));
      }
    }
    const double exact = SegmentDistance(a0, a1, b0, b1);
    EXPECT_LE(exact, best + 1e-6);
    EXPECT_NEAR(exact, best, 0.02);
  }
}

TEST(CapsuleRadiiTest, FollowTheBodyParts) {
  const Skeleton skeleton = SbuSkeleton();
  const std::vector<double> radii = CapsuleRadii(skeleton, SbuParts());
  const auto radius = [&](const char* parent, const char* child) {
    for (size_t i = 0; i < skeleton.bones.size(); ++i) {
      if (skeleton.bones[i] == Bone{skeleton.Find(parent), skeleton.Find(child)}) return radii[i];
    }
    return -1.0;
  };
  EXPECT_EQ(radius("left_elbow", "left_hand"), 0.045);
  EXPECT_EQ(radius("right_knee", "right_foot"), 0.065);
  EXPECT_EQ(radius("neck", "head"), 0.09);
  EXPECT_EQ(radius("torso", "neck"), 0.11);
  EXPECT_EQ(radius("neck", "left_shoulder"), 0.11);
  EXPECT_EQ(radius("torso", "right_hip"), 0.11);
}

}  // namespace
}  // namespace duet::motion
