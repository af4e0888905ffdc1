#include "model/retargeting/euler.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "gtest/gtest.h"
#include "model/base/angle.h"

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

TEST(Euler, AnglesContinueBeyondAFullTurn) {
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

double LargestStep(const std::vector<EulerAngles>& track) {
  double largest = 0;
  for (std::size_t frame = 1; frame < track.size(); ++frame) {
    for (std::size_t i = 0; i < 3; ++i) {
      largest = std::max(largest, std::abs(track[frame][i] - track[frame - 1][i]));
    }
  }
  return largest;
}

double LargestTrueStep(const std::vector<Quaternion>& turns) {
  double largest = 0;
  for (std::size_t frame = 1; frame < turns.size(); ++frame) {
    largest = std::max(largest, Angle(turns[frame], turns[frame - 1]));
  }
  return largest;
}

double LargestError(const std::vector<EulerAngles>& track, const std::vector<Quaternion>& turns,
                    const EulerOrder& order) {
  double largest = 0;
  for (std::size_t frame = 0; frame < turns.size(); ++frame) {
    largest = std::max(largest, Angle(FromEuler(track[frame], order), turns[frame]));
  }
  return largest;
}

// A limb that swings through the lock and on: no angle turns farther than the limb.
TEST(EulerTrack, ThroughGimbalLockNoAngleChangesMoreThanTheJoint) {
  for (const EulerOrder& order : kOrders) {
    for (const double side : {1.0, -1.0}) {
      std::vector<Quaternion> turns;
      for (int frame = 0; frame <= 40; ++frame) {
        turns.push_back(FromEuler({0.4, side * (0.6 + 0.05 * frame), -0.2}, order));
      }
      const std::vector<EulerAngles> track = ToEulerTrack(turns, order);
      EXPECT_LT(LargestError(track, turns, order), 2e-5);
      EXPECT_LT(LargestStep(track), LargestTrueStep(turns) + 1e-5);
    }
  }
}

// Up to the lock, eleven frames in it, and down on another side, a quarter turn away: what the lock
// leaves open has its quarter turn while the limb stands, a share of it each frame.
TEST(EulerTrack, TheFreeAngleInGimbalLockIsInterpolated) {
  for (const EulerOrder& order : kOrders) {
    std::vector<Quaternion> turns;
    for (int frame = 0; frame <= 20; ++frame) {
      turns.push_back(FromEuler({0, kPi / 2 - 0.05 * (20 - frame), 0}, order));
    }
    for (int frame = 0; frame < 10; ++frame) turns.push_back(turns.back());
    const Quaternion top = turns.back();
    const Quaternion aside = FromEuler({kPi / 2, 0, 0}, order);  // turns the way down
    for (int frame = 1; frame <= 20; ++frame) {
      const Quaternion down = AxisAngle(
          {order[1] == 0 ? 1.0 : 0.0, order[1] == 1 ? 1.0 : 0.0, order[1] == 2 ? 1.0 : 0.0},
          -0.05 * frame);
      turns.push_back(aside * down * Inverse(aside) * top);
    }
    const std::vector<EulerAngles> track = ToEulerTrack(turns, order);
    EXPECT_LT(LargestError(track, turns, order), 2e-5);
    EXPECT_NEAR(LargestStep(track), kPi / 2 / 10, 1e-3);
  }
}

// Past the lock at one degree, with three degrees a frame.
std::vector<Quaternion> PastTheLock(const EulerOrder& order) {
  const double degree = kPi / 180;
  std::vector<Quaternion> turns;
  for (int frame = -10; frame <= 10; ++frame) {
    const double along = 3 * degree * (frame + 0.5), aside = degree;
    turns.push_back(
        FromEuler({std::atan2(aside, along), kPi / 2 - std::hypot(along, aside), 0}, order) *
        FromEuler({0, 0, -((order[0] + 1) % 3 == order[1] ? 1 : -1) * std::atan2(aside, along)},
                  order));
  }
  return turns;
}

TEST(EulerTrack, NearGimbalLockAnglesChangeByAtMostAQuarterTurn) {
  const double degree = kPi / 180;
  for (const EulerOrder& order : kOrders) {
    const std::vector<Quaternion> turns = PastTheLock(order);
    const std::vector<EulerAngles> track = ToEulerTrack(turns, order);
    EXPECT_LT(LargestTrueStep(turns), 5 * degree);
    EXPECT_LT(LargestStep(track), kPi / 2 + LargestTrueStep(turns));
    EXPECT_LT(LargestError(track, turns, order), 2e-5);
  }
}

// One frame in the lock has no time to turn: half on the way in, half on the way out.
TEST(EulerTrack, OneFrameInGimbalLockGetsHalfTheChange) {
  const EulerOrder order = {2, 0, 1};
  const std::vector<Quaternion> turns = {FromEuler({0.1, 1.5, 0}, order),
                                         FromEuler({0.1, kPi / 2, 0}, order),
                                         FromEuler({0.9, 1.5, -0.8}, order)};
  const std::vector<EulerAngles> track = ToEulerTrack(turns, order);
  EXPECT_NEAR(track[1][2], (track[0][2] + track[2][2]) / 2, 1e-9);
  EXPECT_LT(LargestStep(track), 0.6);
  EXPECT_LT(LargestError(track, turns, order), 2e-5);
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
