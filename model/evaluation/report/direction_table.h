#ifndef DUET_MODEL_EVALUATION_REPORT_DIRECTION_TABLE_H_
#define DUET_MODEL_EVALUATION_REPORT_DIRECTION_TABLE_H_

#include <string>
#include <vector>

#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// What one way of telling where partners are is off by, degrees, over all tests.
struct DirectionRow {
  std::string name;
  std::vector<double> errors;
};

// How many tests, the median and the 90th percentile of each row's errors, linear between
// neighbours. A row of no errors has no figures.
Table DirectionTable(const std::vector<DirectionRow>& rows);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_DIRECTION_TABLE_H_
