#include "contrib/load/program/report_files.h"

#include <algorithm>
#include <ostream>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "model/base/file.h"
#include "model/base/program_output.h"

namespace duet::contrib::load::program {
namespace {

constexpr char kStandardOutput[] = "-";

}  // namespace

ReportHead MakeHead(const LoadArguments& arguments, const char* what,
                    std::vector<std::pair<std::string, std::string>> settings) {
  ReportHead head;
  head.title = arguments.title.empty() ? absl::StrCat(what, " on ", arguments.server.address)
                                       : arguments.title;
  head.program = "duet-load " DUET_VERSION;
  head.time = absl::FormatTime("%Y-%m-%d %H:%M:%S UTC", absl::Now(), absl::UTCTimeZone());
  head.server = arguments.server.address;
  head.settings = std::move(settings);
  return head;
}

absl::Status WriteReport(const std::string& text, const std::vector<ReportFile>& files,
                         std::ostream* out) {
  const auto standard = std::find_if(files.begin(), files.end(), [](const ReportFile& file) {
    return file.path == kStandardOutput;
  });
  *out << (standard == files.end() ? text : standard->content());
  if (const absl::Status written = base::FlushOutput(out); !written.ok()) return written;
  for (const ReportFile& file : files) {
    if (file.path.empty() || file.path == kStandardOutput) continue;
    absl::Status status = base::WriteFile(file.path, file.content());
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace duet::contrib::load::program
