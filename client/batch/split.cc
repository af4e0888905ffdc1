#include "client/batch/split.h"

#include <cstdint>

#include "absl/strings/numbers.h"

namespace duet::client::batch {
namespace {

constexpr char kValidation[] = "validation";
constexpr char kTest[] = "test";

// The first eight hex digits of the digest as a number in [0, 1); 0 for anything else.
double Fraction(absl::string_view sha256) {
  uint32_t value = 0;
  if (!absl::SimpleHexAtoi(sha256.substr(0, 8), &value)) return 0;
  return value / 4294967296.0;
}

}  // namespace

std::vector<std::string> SplitNames(const Splits& splits) {
  std::vector<std::string> names = {kTrain};
  if (splits.validation > 0) names.emplace_back(kValidation);
  if (splits.test > 0) names.emplace_back(kTest);
  return names;
}

// "test" has the lowest fractions and "validation" the highest, so that changing one share does not
// move leaders of the other split.
std::string SplitOf(const Splits& splits, absl::string_view sha256) {
  const double fraction = Fraction(sha256);
  if (fraction < splits.test) return kTest;
  return fraction >= 1 - splits.validation ? kValidation : kTrain;
}

}  // namespace duet::client::batch
