#ifndef DUET_MODEL_EVALUATION_REPORT_LONG_TABLES_H_
#define DUET_MODEL_EVALUATION_REPORT_LONG_TABLES_H_

#include <string>
#include <vector>

#include "model/evaluation/experiments/long_clips.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// Three tables of followers of long leaders, each titled with `what` ("60 s, without a start"): the
// lean by leader and class; all figures by leader, for the worst class; and by class, for the worst
// leader. Rows begin with the model's name.
std::vector<Table> LongTables(const std::string& what, const std::vector<std::string>& classes,
                              const std::vector<experiments::LongClipRow>& rows);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_LONG_TABLES_H_
