#ifndef DUET_MODEL_EVALUATION_REPORT_REPORT_H_
#define DUET_MODEL_EVALUATION_REPORT_REPORT_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::report {

// What a report is made of. Tables and figures are numbered through all sections, in their order.
struct Report {
  std::string title;
  std::vector<ResultSection> sections;
};

// What its readers must know before the first table.
std::string ReadingGuide();

// The latest date of a section; empty without sections.
std::string LatestDate(const Report& report);

// Writes report.md, index.html and every figure as <name>.svg to a folder, each file whole or not
// at all.
absl::Status WriteReport(const Report& report, const std::filesystem::path& folder);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_REPORT_H_
