#include "model/retargeting/euler.h"

#include <cmath>
#include <random>
#include <vector>

#include "gtest/gtest.h"

namespace duet::retargeting {
namespace {

constexpr double kPi = 3.14159265358979323846;
const std::vector<EulerOrder> kOrders = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                         {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

TEST(Euler, GivesTheAnglesBack) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-3, 3);
  for (const EulerOrder& order : kOrders) {
    for (int i = 0; i < 200; ++i) {
      const EulerAngles angles = {angle(random), angle(random), angle(random)};
      const Quaternion q = FromEuler(angles, order);
      const EulerAngles found = ToEuler(q, order, angles);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], angles[k], 1e-6);
    }
  }
}

TEST(Euler, TheFirstAngleIsTheOutermost) {
  const Quaternion q = FromEuler({0.3, 0.4, 0.5}, {2, 0, 1});
  const Quaternion wanted =
      AxisAngle({0, 0, 1}, 0.3) * AxisAngle({1, 0, 0}, 0.4) * AxisAngle({0, 1, 0}, 0.5);
  EXPECT_NEAR(Angle(q, wanted), 0, 1e-6);
}

TEST(Euler, AWholeTurnGoesOn) {
  for (const EulerOrder& order : kOrders) {
    EulerAngles angles = {};
    for (double turn = 0; turn < 4 * kPi; turn += 0.1) {
      angles = ToEuler(FromEuler({turn, 0.2, -0.1}, order), order, angles);
    }
    EXPECT_GT(angles[0], 12);
  }
}

TEST(Euler, InGimbalLockTheLastAngleStays) {
  for (const EulerOrder& order : kOrders) {
    for (const double middle : {kPi / 2, -kPi / 2}) {
      const Quaternion q = FromEuler({0.7, middle, 0.4}, order);
      const EulerAngles found = ToEuler(q, order, {0.5, middle, 0.1});
      EXPECT_NEAR(found[2], 0.1, 1e-9);
      EXPECT_NEAR(Angle(FromEuler(found, order), q), 0, 1e-5);
    }
  }
}

}  // namespace
}  // namespace duet::retargeting
