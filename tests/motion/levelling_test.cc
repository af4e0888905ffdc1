#include "model/motion/levelling.h"

#include <gtest/gtest.h>

#include <cmath>

namespace duet::motion {
namespace {

void ExpectNear(Vec3 a, Vec3 b, float tolerance) { EXPECT_LT(Distance(a, b), tolerance); }

TEST(LevellingTest, DefaultChangesNothing) {
  const Vec3 point = {0.1f, -1.7f, 2.3f};
  EXPECT_EQ(Levelling().Apply(point), point);
  EXPECT_EQ(Levelling().Invert(point), point);
}

TEST(LevellingTest, VerticalAndFloorComeToTheirPlaces) {
  // The camera is pitched by 10 degrees: the vertical leans along +z.
  const float angle = 10 * static_cast<float>(M_PI) / 180;
  const Levelling levelling({0, 2 * std::cos(angle), 2 * std::sin(angle)}, -0.8f);
  ExpectNear(levelling.Apply({0, std::cos(angle), std::sin(angle)}), {0, 1.8f, 0}, 1e-6f);
  // Across the view nothing turns; along it the camera's axis rises.
  ExpectNear(levelling.Apply({1, 0, 0}), {1, 0.8f, 0}, 1e-6f);
  ExpectNear(levelling.Apply({0, 0, 1}), {0, 0.8f + std::sin(angle), std::cos(angle)}, 1e-6f);
}

TEST(LevellingTest, KeepsDistancesAndHandedness) {
  const Levelling levelling({0.2f, 0.9f, -0.3f}, 1);
  const Vec3 origin = levelling.Apply({0, 0, 0});
  const Vec3 x = levelling.Apply({1, 0, 0}) - origin;
  const Vec3 y = levelling.Apply({0, 1, 0}) - origin;
  const Vec3 z = levelling.Apply({0, 0, 1}) - origin;
  ExpectNear(Cross(x, y), z, 1e-6f);
  EXPECT_NEAR(Norm(x), 1, 1e-6);
  EXPECT_NEAR(Norm(y), 1, 1e-6);
}

TEST(LevellingTest, InvertUndoesApply) {
  const Levelling levelling({0.1f, 1, 0.17f}, -0.83f);
  const Poses captured(2, {{0.3f, -0.2f, 2.5f}, {-1.2f, 0.8f, 3.4f}});
  const Poses back = levelling.Invert(levelling.Apply(captured));
  for (int j = 0; j < 2; ++j) ExpectNear(back.at(0, j), captured.at(0, j), 2e-6f);
}

}  // namespace
}  // namespace duet::motion
