#include "model/evaluation/report/ticks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace duet::evaluation::report {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;

TEST(RoundTicksTest, AreRoundAndInside) {
  EXPECT_THAT(RoundTicks(0, 10, 5), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(RoundTicks(-1, 2, 6), ElementsAre(-1, -0.5, 0, 0.5, 1, 1.5, 2));
  EXPECT_THAT(RoundTicks(1203, 1297, 5), ElementsAre(1220, 1240, 1260, 1280));
}

TEST(LogTicksTest, ArePowersOfTenWhereThereAreSome) {
  EXPECT_THAT(LogTicks(0.01, 150, 6), ElementsAre(DoubleEq(0.01), DoubleEq(0.1), 1, 10, 100));
}

TEST(LogTicksTest, HaveDoublesAndFivesBetweenFewPowers) {
  EXPECT_THAT(LogTicks(0.9, 25, 6), ElementsAre(1, 2, 5, 10, 20));
}

TEST(LogTicksTest, AreEvenWithinLessThanThat) {
  EXPECT_THAT(LogTicks(4, 6, 4), ElementsAre(4, 4.5, 5, 5.5, 6));
}

TEST(TickTextTest, IsShort) {
  EXPECT_EQ(TickText(0.25), "0.25");
  EXPECT_EQ(TickText(-1e-15), "0");
  EXPECT_EQ(TickText(2e6), "2e+06");
}

}  // namespace
}  // namespace duet::evaluation::report
