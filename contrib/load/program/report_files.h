#ifndef DUET_CONTRIB_LOAD_PROGRAM_REPORT_FILES_H_
#define DUET_CONTRIB_LOAD_PROGRAM_REPORT_FILES_H_

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "contrib/load/program/load_flags.h"
#include "contrib/load/report.h"

namespace duet::contrib::load::program {

// The head of a report that begins now. `settings`: from GivenFlags.
ReportHead MakeHead(const LoadArguments& arguments, const char* what,
                    std::vector<std::pair<std::string, std::string>> settings);

// A form of a report and the file for it: an empty path for none, - for standard output.
struct ReportFile {
  std::filesystem::path path;
  std::function<std::string()> content;
};

// Writes the files. A file on standard output (`out`) takes the place of the text.
absl::Status WriteReport(const std::string& text, const std::vector<ReportFile>& files,
                         std::ostream* out);

}  // namespace duet::contrib::load::program

#endif  // DUET_CONTRIB_LOAD_PROGRAM_REPORT_FILES_H_
