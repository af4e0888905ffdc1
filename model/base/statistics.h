#ifndef DUET_MODEL_BASE_STATISTICS_H_
#define DUET_MODEL_BASE_STATISTICS_H_

#include <vector>

namespace duet::base {

// The mean of the values that are not NaN; NaN without any.
double Mean(const std::vector<double>& values);

// The value below which a share (0 to 1) of the values are, interpolated linearly; NaN without any.
// Requires none that is NaN.
double Quantile(std::vector<double> values, double share);

struct MeanAndDeviation {
  double mean = 0;
  double deviation = 0;  // with divisor n - 1; NaN for fewer than 2 values
};
// NaN for no value, and where a value is NaN.
MeanAndDeviation Summarise(const std::vector<double>& values);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_STATISTICS_H_
