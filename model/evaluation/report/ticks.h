#ifndef DUET_MODEL_EVALUATION_REPORT_TICKS_H_
#define DUET_MODEL_EVALUATION_REPORT_TICKS_H_

#include <string>
#include <vector>

namespace duet::evaluation::report {

// Round numbers within [low, high] in about `count` steps: multiples of 1, 2 or 5 times a power of
// ten. Requires low < high.
std::vector<double> RoundTicks(double low, double high, int count);

// The same for a logarithmic axis: powers of ten; their doubles and fives too where there are few;
// evenly spaced numbers where the axis spans less. Requires 0 < low < high.
std::vector<double> LogTicks(double low, double high, int count);

// A number in few digits: "0", "0.25", "1e+06".
std::string TickText(double value);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_TICKS_H_
