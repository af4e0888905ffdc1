#include "contrib/load/log_histogram.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

#include "model/base/random.h"

namespace duet::contrib::load {
namespace {

TEST(LogHistogramTest, IsEmptyAtFirst) {
  const LogHistogram histogram;
  EXPECT_EQ(histogram.count(), 0);
  EXPECT_EQ(histogram.Percentile(50), 0);
  EXPECT_EQ(histogram.mean(), 0);
}

TEST(LogHistogramTest, SmallValuesAreExact) {
  LogHistogram histogram;
  for (int value = 1; value <= 100; ++value) histogram.Add(value);
  EXPECT_EQ(histogram.count(), 100);
  EXPECT_EQ(histogram.Percentile(0), 1);
  EXPECT_EQ(histogram.Percentile(1), 1);
  EXPECT_EQ(histogram.Percentile(50), 50);
  EXPECT_EQ(histogram.Percentile(50.5), 51);
  EXPECT_EQ(histogram.Percentile(99), 99);
  EXPECT_EQ(histogram.Percentile(100), 100);
  EXPECT_DOUBLE_EQ(histogram.mean(), 50.5);
}

TEST(LogHistogramTest, PercentilesAreWithinTheStatedError) {
  base::Random random(1);
  for (int round = 0; round < 2000; ++round) {
    // Two neighbours of one value, so that it is neither smallest nor largest.
    const int64_t value = random.Below(int64_t{1} << (1 + random.Below(61)));
    LogHistogram histogram;
    histogram.Add(0);
    histogram.Add(value);
    histogram.Add(int64_t{1} << 62);
    const double read = static_cast<double>(histogram.Percentile(50));
    EXPECT_LE(std::abs(read - static_cast<double>(value)), 0.008 * static_cast<double>(value))
        << value;
  }
}

TEST(LogHistogramTest, SmallestAndLargestAreExact) {
  LogHistogram histogram;
  for (const int64_t value : {1234567, 7654321, 4000000}) histogram.Add(value);
  EXPECT_EQ(histogram.Percentile(0), 1234567);
  EXPECT_EQ(histogram.Percentile(100), 7654321);
}

TEST(LogHistogramTest, RankOfP999IsNotRoundedUp) {
  LogHistogram histogram;
  for (int i = 0; i < 999; ++i) histogram.Add(10);
  histogram.Add(5000);
  EXPECT_EQ(histogram.Percentile(99.9), 10);
  histogram.Add(5000);
  EXPECT_EQ(histogram.Percentile(99.9), 5000);
}

TEST(LogHistogramTest, OutOfRangeValuesAreClamped) {
  LogHistogram histogram;
  histogram.Add(-5);
  histogram.Add(INT64_MAX);
  EXPECT_EQ(histogram.min(), 0);
  EXPECT_EQ(histogram.max(), int64_t{1} << 62);
}

TEST(LogHistogramTest, MergedHistogramsEqualOne) {
  LogHistogram low, high, both;
  for (int value = 1; value <= 1000; ++value) {
    (value <= 300 ? low : high).Add(1000 * value);
    both.Add(1000 * value);
  }
  LogHistogram together;
  together.Add(high);
  together.Add(low);
  together.Add(LogHistogram());
  EXPECT_EQ(together.count(), 1000);
  EXPECT_EQ(together.min(), 1000);
  EXPECT_EQ(together.max(), 1000000);
  EXPECT_DOUBLE_EQ(together.mean(), both.mean());
  for (const double percent : {1.0, 30.0, 50.0, 99.0}) {
    EXPECT_EQ(together.Percentile(percent), both.Percentile(percent));
  }
}

}  // namespace
}  // namespace duet::contrib::load
