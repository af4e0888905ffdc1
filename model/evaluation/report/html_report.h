#ifndef DUET_MODEL_EVALUATION_REPORT_HTML_REPORT_H_
#define DUET_MODEL_EVALUATION_REPORT_HTML_REPORT_H_

#include <string>

#include "model/evaluation/report/report.h"

namespace duet::evaluation::report {

// The report as one page that needs no other file: style and figures inline, for wide and narrow
// screens, light and dark, and for print.
std::string ToHtml(const Report& report);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_HTML_REPORT_H_
