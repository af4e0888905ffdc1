#ifndef DUET_MODEL_EVALUATION_REPORT_VALIDATION_TABLE_H_
#define DUET_MODEL_EVALUATION_REPORT_VALIDATION_TABLE_H_

#include <string>
#include <vector>

#include "model/evaluation/report/table.h"
#include "model/evaluation/report/training_curves.h"

namespace duet::evaluation::report {

// Runs of one configuration, each with people of its own left out and held back.
struct ValidatedRuns {
  std::string name;
  std::vector<LoggedRun> runs;  // named by who was left out
};

// The validation error (metres) after the last epoch: a row for each configuration, a column for
// each run's name and the mean over them; NaN where a configuration lacks a run or the column.
// `column` is training_log's: "validation_afd" or "validation_afd_pose".
Table ValidationTable(const std::string& title, const std::string& column,
                      const std::vector<ValidatedRuns>& configurations);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_VALIDATION_TABLE_H_
