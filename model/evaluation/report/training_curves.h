#ifndef DUET_MODEL_EVALUATION_REPORT_TRAINING_CURVES_H_
#define DUET_MODEL_EVALUATION_REPORT_TRAINING_CURVES_H_

#include <string>
#include <vector>

#include "model/evaluation/experiments/training_log.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::report {

// A run of duet-train, and how figures and tables call it.
struct LoggedRun {
  std::string name;
  experiments::TrainingLog log;
};

// How runs went: of one run, its losses in one figure; of several, a figure for each loss with a
// line for each run; the validation error where there is one; and what the runs took and reached.
// Losses that are zero throughout were switched off, and are left out. Figures are named
// <id>_<loss>; text, settings and command are left to the caller.
ResultSection DrawTrainingCurves(const std::vector<LoggedRun>& runs, const std::string& id);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_TRAINING_CURVES_H_
