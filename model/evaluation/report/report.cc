#include "model/evaluation/report/report.h"

#include <algorithm>
#include <system_error>

#include "model/base/file.h"
#include "model/evaluation/report/html_report.h"
#include "model/evaluation/report/markdown_report.h"

namespace duet::evaluation::report {

std::string ReadingGuide() {
  return "The best figures of a column are bold, ties included. Rows marked as printed are the "
         "paper's own figures: they were not measured here, are never marked as best, and compare "
         "only as far as the notes below their table say. A dash is a figure that does not exist.";
}

std::string LatestDate(const Report& report) {
  std::string latest;
  for (const ResultSection& section : report.sections) latest = std::max(latest, section.date);
  return latest;
}

absl::Status WriteReport(const Report& report, const std::filesystem::path& folder) {
  std::error_code error;  // a folder that cannot be made shows in the first file
  std::filesystem::create_directories(folder, error);
  for (const ResultSection& section : report.sections) {
    for (const ResultFigure& figure : section.figures) {
      absl::Status status = base::WriteFile(folder / (figure.name + ".svg"), figure.svg);
      if (!status.ok()) return status;
    }
  }
  absl::Status status = base::WriteFile(folder / "report.md", ToMarkdown(report));
  if (!status.ok()) return status;
  return base::WriteFile(folder / "index.html", ToHtml(report));
}

}  // namespace duet::evaluation::report
