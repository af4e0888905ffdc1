#include "model/authoring/monotone_cubic.h"

#include <algorithm>
#include <cmath>

#include "gtest/gtest.h"

namespace duet::authoring {
namespace {

const std::vector<MonotoneCubic::Key> kKeys = {{0, 1}, {1, 3}, {1.5, 3}, {2, 7}, {4, 8}, {5, -2}};

TEST(MonotoneCubic, PassesItsKeysAndHoldsBeyondThem) {
  const MonotoneCubic curve(kKeys);
  for (const auto& key : kKeys) EXPECT_NEAR(curve.At(key.time), key.value, 1e-12);
  EXPECT_EQ(curve.At(-1), 1);
  EXPECT_EQ(curve.At(99), -2);
  EXPECT_EQ(MonotoneCubic({{0, 4}}).At(0.5), 4);
}

TEST(MonotoneCubic, StaysBetweenTheKeysAround) {
  const MonotoneCubic curve(kKeys);
  for (std::size_t k = 0; k + 1 < kKeys.size(); ++k) {
    const auto& a = kKeys[k];
    const auto& b = kKeys[k + 1];
    for (double t = a.time; t <= b.time; t += 0.01) {
      EXPECT_GE(curve.At(t), std::min(a.value, b.value) - 1e-12) << t;
      EXPECT_LE(curve.At(t), std::max(a.value, b.value) + 1e-12) << t;
    }
  }
}

TEST(MonotoneCubic, HasContinuousVelocityAndEasesAtTheEnds) {
  const MonotoneCubic curve(kKeys);
  const double h = 1e-5;
  for (const auto& key : kKeys) {
    const double before = (curve.At(key.time) - curve.At(key.time - h)) / h;
    const double after = (curve.At(key.time + h) - curve.At(key.time)) / h;
    EXPECT_NEAR(before, after, 1e-3) << key.time;
  }
  EXPECT_NEAR((curve.At(h) - curve.At(0)) / h, 0, 1e-3);
}

}  // namespace
}  // namespace duet::authoring
