#ifndef DUET_MODEL_EVALUATION_REPORT_HTML_TABLE_H_
#define DUET_MODEL_EVALUATION_REPORT_HTML_TABLE_H_

#include <string>

#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// A table element with the caption "Table <number>. <title>" and its notes below. The paper's
// printed rows are a group of their own below those measured here.
std::string ToHtml(const Table& table, int number);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_HTML_TABLE_H_
