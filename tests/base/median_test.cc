#include "model/base/median.h"

#include <gtest/gtest.h>

namespace duet::base {
namespace {

TEST(Median, IsTheMiddleValueInAnyOrder) {
  EXPECT_EQ(Median<int>({5}), 5);
  EXPECT_EQ(Median<int>({9, 1, 5}), 5);
  EXPECT_EQ(Median<double>({0.5, -2, 7, 0.25, 100}), 0.5);
}

TEST(Median, IsTheUpperOfTwoMiddleValues) { EXPECT_EQ(Median<int>({4, 1, 3, 2}), 3); }

}  // namespace
}  // namespace duet::base
