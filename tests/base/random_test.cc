#include "model/base/random.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>

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

TEST(RandomTest, StreamsDependOnlyOnSeedAndPart) {
  std::set<double> first;
  for (const uint64_t seed : {1, 2}) {
    for (const int64_t part : {2, 3}) {
      EXPECT_EQ(Random(seed, part).Uniform(), Random(seed, part).Uniform());
      first.insert(Random(seed, part).Uniform());
    }
    first.insert(Random(seed).Uniform());
  }
  EXPECT_EQ(first.size(), 6u) << "all of them differ";
}

TEST(RandomTest, UniformNumbersFillTheirInterval) {
  Random random(7, 0);
  double low = 1, high = 0;
  for (int i = 0; i < 20000; ++i) {
    const double drawn = random.Uniform();
    low = std::min(low, drawn);
    high = std::max(high, drawn);
  }
  EXPECT_GE(low, 0);
  EXPECT_LT(low, 0.01);
  EXPECT_LT(high, 1);
  EXPECT_GT(high, 0.99);
}

TEST(RandomTest, NormalNumbersHaveTheirDeviation) {
  Random random(7, 0);
  constexpr int kDraws = 20000;
  double sum = 0, squares = 0, standard_squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double drawn = random.Normal(2), standard = random.StandardNormal();
    sum += drawn + standard;
    squares += drawn * drawn;
    standard_squares += standard * standard;
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.1);
  EXPECT_NEAR(squares / kDraws, 4, 0.2);
  EXPECT_NEAR(standard_squares / kDraws, 1, 0.05);
}

TEST(RandomTest, ChanceHasItsProbability) {
  Random random(7, 0);
  int taken = 0;
  for (int i = 0; i < 10000; ++i) {
    taken += random.Chance(0.25) ? 1 : 0;
    EXPECT_FALSE(random.Chance(0));
    EXPECT_TRUE(random.Chance(1));
  }
  EXPECT_NEAR(taken, 2500, 150);
}

}  // namespace
}  // namespace duet::base
