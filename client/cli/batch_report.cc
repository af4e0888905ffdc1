#include "client/cli/batch_report.h"

#include <ostream>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {

void Report(const BatchArguments& arguments, const std::filesystem::path& folder,
            const batch::JobReport& report, const ProgramEnvironment& environment) {
  const int64_t settled = report.set.done + report.set.rejected + report.set.failed;
  if (arguments.json) {
    const nlohmann::ordered_json event = {{"event", "end"},
                                          {"folder", folder.string()},
                                          {"planned", report.planned},
                                          {"done", report.set.done},
                                          {"rejected", report.set.rejected},
                                          {"failed", report.set.failed},
                                          {"missing", report.planned - settled},
                                          {"bytes", report.set.bytes},
                                          {"packed", report.packed},
                                          {"stopped", std::string(report.stopped.message())}};
    *environment.out << event.dump() << "\n";
  } else if (!arguments.quiet) {
    *environment.out << folder.string() << ": " << report.set.done << " done, "
                     << report.set.rejected << " rejected, " << report.set.failed << " failed, "
                     << report.planned - settled << " missing\n";
  }
  if (arguments.json || !report.packed || report.set.failed == 0) return;
  *environment.err << "duet: the shards leave out the " << report.set.failed
                   << " that failed; --retry-failed asks for them again, and adds a shard\n";
}

void Report(const BatchArguments& arguments, const batch::Estimate& estimate,
            const ProgramEnvironment& environment) {
  if (arguments.json) {
    const nlohmann::ordered_json event = {
        {"event", "estimate"},         {"items", estimate.items},
        {"leaders", estimate.leaders}, {"unreadable", estimate.unreadable},
        {"frames", estimate.frames},   {"seconds", estimate.seconds},
        {"bytes", estimate.bytes},     {"problems", estimate.problems}};
    *environment.out << event.dump() << "\n";
    return;
  }
  *environment.out << absl::StrFormat(
      "%d items of %d leaders, %d frames: about %.0f s of calls one after the other, %.1f MB\n",
      estimate.items, estimate.leaders, estimate.frames, estimate.seconds, estimate.bytes / 1e6);
  if (estimate.unreadable == 0) return;
  *environment.err << estimate.unreadable << " leaders cannot be read:\n";
  for (const std::string& problem : estimate.problems) *environment.err << "  " << problem << "\n";
}

void Report(const BatchArguments& arguments, const batch::MergeReport& report,
            const ProgramEnvironment& environment) {
  if (arguments.json) {
    const nlohmann::ordered_json object = {{"planned", report.planned},
                                           {"missing", report.missing}};
    *environment.out << object.dump() << "\n";
    return;
  }
  *environment.out << arguments.out.string() << ": " << report.planned << " items merged\n";
  if (report.missing.empty()) return;
  *environment.err << "duet: no shard has items " << absl::StrJoin(report.missing, ", ")
                   << "; run their shards again\n";
}

void Report(const BatchArguments& arguments, const batch::VerifyReport& report,
            const ProgramEnvironment& environment) {
  if (arguments.json) {
    const nlohmann::ordered_json object = {{"items", report.items},
                                           {"files", report.files},
                                           {"missing", report.missing},
                                           {"problem_count", report.problem_count},
                                           {"problems", report.problems}};
    *environment.out << object.dump() << "\n";
    return;
  }
  *environment.out << arguments.out.string() << ": " << report.items << " items, " << report.files
                   << " files, " << report.problem_count << " problems, " << report.missing
                   << " items missing\n";
  for (const std::string& problem : report.problems) *environment.err << problem << "\n";
  if (report.problem_count == 0 || arguments.repair) return;
  *environment.err << "duet: duet batch verify --repair asks again for what is missing or was "
                      "changed, and so does the command that made it\n";
}

void ReportPassedOver(const BatchArguments& arguments, const std::vector<std::string>& files,
                      const ProgramEnvironment& environment) {
  if (files.empty() || arguments.quiet) return;
  *environment.err << "passed over, no motion: " << files.front();
  if (files.size() > 1) *environment.err << " and " << files.size() - 1 << " more";
  *environment.err << "\n";
}

}  // namespace duet::client::cli
