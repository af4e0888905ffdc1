#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {
namespace {

using base::kPi;
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

TEST(Euler, AnglesReproduceTheRotationNearGimbalLock) {
  for (const EulerOrder& order : kOrders) {
    for (double first = -7; first < 7; first += 0.9) {
      for (double middle : {-kPi / 2, -1.5707, -1.0, 0.0, 0.4, 1.57079, kPi / 2, 2.5}) {
        for (double last = -4; last < 4; last += 0.7) {
          const Quaternion q = FromEuler({first, middle, last}, order);
          for (const EulerAngles& previous : {EulerAngles{}, EulerAngles{1, 2, 3}}) {
            const EulerAngles found = ToEuler(q, order, previous);
            EXPECT_LT(Angle(FromEuler(found, order), q), 2e-5)
                << first << " " << middle << " " << last;
          }
        }
      }
    }
  }
}

TEST(Euler, TheMiddleAnglePassesOverTheTop) {
  for (const EulerOrder& order : kOrders) {
    EulerAngles angles = {0.2, 0, 0};
    for (int step = 0; step <= 1000; ++step) {
      const EulerAngles truth = {0.2, step * 0.003, step * 0.025};
      const EulerAngles next = ToEuler(FromEuler(truth, order), order, angles);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(std::abs(next[i] - angles[i]), 0.1) << step;
      angles = next;
    }
    EXPECT_NEAR(angles[1], 3, 1e-6);
    EXPECT_NEAR(angles[2], 25, 1e-6);
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

double LargestError(const std::vector<EulerAngles>& track, const std::vector<Quaternion>& turns,
                    const EulerOrder& order) {
  double largest = 0;
  for (std::size_t frame = 0; frame < turns.size(); ++frame) {
    largest = std::max(largest, Angle(FromEuler(track[frame], order), turns[frame]));
  }
  return largest;
}

TEST(EulerTrack, NoFrameAndOnlyLockedFramesAreValid) {
  EXPECT_TRUE(ToEulerTrack({}, {2, 0, 1}).empty());
  const Quaternion locked = FromEuler({0.3, kPi / 2, 0}, {2, 0, 1});
  const std::vector<EulerAngles> track = ToEulerTrack({locked, locked}, {2, 0, 1});
  ASSERT_EQ(track.size(), 2u);
  EXPECT_EQ(track[0], track[1]);
  EXPECT_LT(LargestError(track, {locked, locked}, {2, 0, 1}), 2e-5);
}

}  // namespace
}  // namespace duet::retargeting
