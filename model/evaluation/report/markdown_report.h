#ifndef DUET_MODEL_EVALUATION_REPORT_MARKDOWN_REPORT_H_
#define DUET_MODEL_EVALUATION_REPORT_MARKDOWN_REPORT_H_

#include <string>

#include "model/evaluation/report/report.h"

namespace duet::evaluation::report {

// The report in GitHub's Markdown. Figures are <name>.svg beside it.
std::string ToMarkdown(const Report& report);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_MARKDOWN_REPORT_H_
