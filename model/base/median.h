#ifndef DUET_MODEL_BASE_MEDIAN_H_
#define DUET_MODEL_BASE_MEDIAN_H_

#include <algorithm>
#include <cstddef>
#include <vector>

namespace duet::base {

// The median; the upper one of the two middle values if their number is even.
// Requires at least one value, none of them NaN.
template <typename Number>
Number Median(std::vector<Number> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_MEDIAN_H_
