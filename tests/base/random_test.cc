#include "model/base/random.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

#include "gmock/gmock.h"
#include "model/base/statistics.h"
#include "tests/support/matchers.h"

namespace duet::base {
namespace {

// The fixed values are those of an implementation of MT19937-64 of its own, in another language:
// published results change when these do.
TEST(RandomTest, ASeedAlwaysGivesTheSameUniformNumbers) {
  Random random(7);
  EXPECT_EQ(random.Uniform(), 0.754385304152858);
  EXPECT_EQ(random.Uniform(), 0.9493012028926442);
  Random scaled(7);
  EXPECT_DOUBLE_EQ(scaled.Uniform(-2, 3), -2 + 5 * 0.754385304152858);
}

// Half a step above the number that Uniform returns, so never 0. Above a quarter, sums are rounded.
TEST(RandomTest, OpenUniformLiesBetweenTheStepsOfUniform) {
  int tried = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const double uniform = Random(seed).Uniform();
    if (uniform > 0.25) continue;
    EXPECT_EQ(Random(seed).OpenUniform(), uniform + std::ldexp(0.5, -53)) << seed;
    ++tried;
  }
  EXPECT_GT(tried, 0);
}

TEST(RandomTest, ASeedAndAPartAlwaysGiveTheSameUniformNumbers) {
  EXPECT_EQ(Random(7, 3).Uniform(), 0.87403660426517851);
  // All 64 bits of both count.
  EXPECT_EQ(Random((uint64_t{1} << 40) + 5, -1).Uniform(), 0.61264998305390861);
}

TEST(RandomTest, NormalNumbersStayTheSame) {
  Random random(7);
  EXPECT_DOUBLE_EQ(random.Normal(2), 3.1827997512939126);
  EXPECT_DOUBLE_EQ(random.Normal(2), 0.77780646941071419);
  Random standard(7);
  EXPECT_DOUBLE_EQ(standard.StandardNormal(), 0.7130298338875809);
  EXPECT_DOUBLE_EQ(standard.StandardNormal(), 1.6105563141402495);
}

TEST(RandomTest, IntegersAndOrdersStayTheSame) {
  Random random(7);
  std::vector<int64_t> drawn;
  for (int i = 0; i < 6; ++i) drawn.push_back(random.Below(10));
  EXPECT_THAT(drawn, ElementsAre(5, 0, 8, 6, 1, 8));
  std::vector<int> values(8);
  std::iota(values.begin(), values.end(), 0);
  Random(7).Shuffle(&values);
  EXPECT_THAT(values, ElementsAre(2, 3, 5, 6, 1, 0, 4, 7));
}

TEST(MeanTest, IgnoresMissingValues) {
  EXPECT_EQ(Mean({1, std::nan(""), 4}), 2.5);
  EXPECT_TRUE(std::isnan(Mean({std::nan("")})));
  EXPECT_TRUE(std::isnan(Mean({})));
}

TEST(QuantileTest, LiesBetweenNeighbours) {
  EXPECT_DOUBLE_EQ(Quantile({40, 10, 30, 20}, 0.5), 25);
  EXPECT_DOUBLE_EQ(Quantile({40, 10, 30, 20}, 0.9), 37);
  EXPECT_EQ(Quantile({7}, 0.9), 7);
  EXPECT_TRUE(std::isnan(Quantile({}, 0.5)));
}

TEST(SummariseTest, MeanAndSampleDeviation) {
  const MeanAndDeviation summary = Summarise({1, 2, 3, 6});
  EXPECT_DOUBLE_EQ(summary.mean, 3);
  EXPECT_DOUBLE_EQ(summary.deviation, std::sqrt(14.0 / 3));
}

TEST(SummariseTest, TooFewValuesHaveNoDeviation) {
  EXPECT_EQ(Summarise({4}).mean, 4);
  EXPECT_TRUE(std::isnan(Summarise({4}).deviation));
  EXPECT_TRUE(std::isnan(Summarise({}).mean));
}

std::vector<double> OneByOne(uint64_t seed, int64_t part, std::size_t count) {
  Random random(seed, part);
  std::vector<double> numbers(count);
  for (double& number : numbers) number = random.OpenUniform();
  return numbers;
}

TEST(FillOpenUniform, EqualsRandomBitForBit) {
  for (const uint64_t seed : {uint64_t{0}, uint64_t{7}, std::numeric_limits<uint64_t>::max()}) {
    for (const int64_t part : {int64_t{0}, int64_t{-3}, int64_t{1} << 40}) {
      std::vector<double> numbers(1000);  // more than three blocks
      FillOpenUniform(seed, part, 1000, numbers.data());
      EXPECT_EQ(numbers, OneByOne(seed, part, 1000)) << seed << " " << part;
    }
  }
}

TEST(FillOpenUniform, WritesOnlyWhatIsAskedFor) {
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{1}, std::size_t{312}, std::size_t{313}}) {
    std::vector<double> numbers(count + 1, -1);
    FillOpenUniform(5, 0, static_cast<std::ptrdiff_t>(count), numbers.data());
    EXPECT_EQ(numbers.back(), -1);
    numbers.pop_back();
    EXPECT_EQ(numbers, OneByOne(5, 0, count));
  }
}

}  // namespace
}  // namespace duet::base
