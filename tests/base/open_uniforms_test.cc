#include "model/base/open_uniforms.h"

#include <cstdint>
#include <limits>
#include <vector>

#include "gtest/gtest.h"
#include "model/base/random.h"

namespace duet::base {
namespace {

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
