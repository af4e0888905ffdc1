#include "model/motion/vec3.h"

#include <cmath>
#include <limits>

#include "gtest/gtest.h"

namespace duet::motion {
namespace {

constexpr double kQuarterTurn = M_PI / 2;

TEST(Vec3, RotateYTurnsZToX) {
  EXPECT_LT(Distance(RotateY({0, 0, 1}, kQuarterTurn), {1, 0, 0}), 1e-6f);
  EXPECT_LT(Distance(RotateY({1, 2, 0}, kQuarterTurn), {0, 2, -1}), 1e-6f);
}

TEST(Vec3, RotateYKeepsHandedness) {
  const Vec3 x = RotateY({1, 0, 0}, 0.7), y = RotateY({0, 1, 0}, 0.7), z = RotateY({0, 0, 1}, 0.7);
  EXPECT_NEAR(Dot(Cross(x, y), z), 1, 1e-6);
}

TEST(Vec3, CrossIsRightHanded) { EXPECT_EQ(Cross({1, 0, 0}, {0, 1, 0}), (Vec3{0, 0, 1})); }

TEST(Vec3, LerpHitsBothEnds) {
  const Vec3 a{1, 2, 3}, b{3, -2, 0};
  EXPECT_EQ(Lerp(a, b, 0), a);
  EXPECT_EQ(Lerp(a, b, 1), b);
  EXPECT_EQ(Lerp(a, b, 0.5f), (Vec3{2, 0, 1.5f}));
}

TEST(Vec3, IsFiniteLooksAtEveryCoordinate) {
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), HUGE_VALF, -HUGE_VALF};
  EXPECT_TRUE(IsFinite({1, -2, 3e38f}));
  for (float value : bad) {
    EXPECT_FALSE(IsFinite({value, 0, 0}));
    EXPECT_FALSE(IsFinite({0, value, 0}));
    EXPECT_FALSE(IsFinite({0, 0, value}));
  }
}

}  // namespace
}  // namespace duet::motion
