#ifndef DUET_MODEL_EVALUATION_REPORT_DIRECTION_TABLE_H_
#define DUET_MODEL_EVALUATION_REPORT_DIRECTION_TABLE_H_

#include <string>
#include <vector>

#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// The errors of one estimate of partners' directions, degrees, over all tests.
struct DirectionRow {
  std::string name;
  std::vector<double> errors;
};

// The number of tests, and median and 90th percentile of each row's errors, interpolated linearly.
// A row without errors has no figures.
Table DirectionTable(const std::vector<DirectionRow>& rows);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_DIRECTION_TABLE_H_
