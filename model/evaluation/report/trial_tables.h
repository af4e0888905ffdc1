#ifndef DUET_MODEL_EVALUATION_REPORT_TRIAL_TABLES_H_
#define DUET_MODEL_EVALUATION_REPORT_TRIAL_TABLES_H_

#include <string>
#include <vector>

#include "model/evaluation/experiments/trials.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// The means and the deviations over each row's trials.
Table MeansTable(const std::string& title, const experiments::Trials& trials);
Table DeviationsTable(const std::string& title, const experiments::Trials& trials);

// Each row's gain over row `base`: its mean, its deviation, and the share of trials in which it is
// above 0, as rows "more", "more, deviation", "more, share above 0" for a row "more".
Table GainsTable(const std::string& title, const experiments::Trials& trials,
                 const std::string& base);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_TRIAL_TABLES_H_
