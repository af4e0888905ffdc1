#ifndef DUET_TESTS_SUPPORT_EXPECT_NEAR_H_
#define DUET_TESTS_SUPPORT_EXPECT_NEAR_H_

#include "gtest/gtest.h"
#include "model/retargeting/rotation.h"

namespace duet::test {

// Expects each component of `a` within `tolerance` of that of `b`.
inline void ExpectNear(retargeting::Vec3d a, retargeting::Vec3d b, double tolerance = 1e-6) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_EXPECT_NEAR_H_
