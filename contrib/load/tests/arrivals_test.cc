#include "contrib/load/arrivals.h"

#include <gtest/gtest.h>

namespace duet::contrib::load {
namespace {

TEST(ArrivalsTest, ConstantArrivalsDoNotDrift) {
  Arrivals arrivals(ArrivalKind::kConstant, 3, 0);
  EXPECT_EQ(arrivals.Next(), Seconds(0));
  EXPECT_EQ(arrivals.Next(), Seconds(1.0 / 3));
  Duration last{0};
  for (int i = 2; i <= 3000; ++i) last = arrivals.Next();
  EXPECT_EQ(last, Seconds(1000));
}

TEST(ArrivalsTest, PoissonArrivalsHaveTheRateAndExponentialGaps) {
  constexpr int kCalls = 20000;
  Arrivals arrivals(ArrivalKind::kPoisson, 100, 7);
  Duration last{0};
  int long_gaps = 0;
  for (int i = 0; i < kCalls; ++i) {
    const Duration next = arrivals.Next();
    ASSERT_GE(next, last);
    if (next - last > Seconds(0.01)) ++long_gaps;
    last = next;
  }
  EXPECT_NEAR(ToSeconds(last), 200, 5);
  EXPECT_NEAR(static_cast<double>(long_gaps) / kCalls, 0.3679, 0.01);  // 1 / e
}

TEST(ArrivalsTest, SeedDeterminesTheDueTimes) {
  Arrivals one(ArrivalKind::kPoisson, 10, 1), same(ArrivalKind::kPoisson, 10, 1);
  Arrivals other(ArrivalKind::kPoisson, 10, 2);
  const Duration first = one.Next();
  EXPECT_EQ(first, same.Next());
  EXPECT_NE(first, other.Next());
}

TEST(WeightedChoiceTest, SharesMatchTheWeights) {
  const WeightedChoice choice({1, 3});
  EXPECT_EQ(choice.Pick(0), 0U);
  EXPECT_EQ(choice.Pick(0.2499), 0U);
  EXPECT_EQ(choice.Pick(0.25), 1U);
  EXPECT_EQ(choice.Pick(0.9999), 1U);
}

}  // namespace
}  // namespace duet::contrib::load
