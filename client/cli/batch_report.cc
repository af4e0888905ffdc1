#include "client/cli/batch_report.h"

#include <algorithm>
#include <ostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/counted.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

// Maximum number of causes in the summary; failed.tsv lists all.
constexpr size_t kCausesShown = 5;

std::string Line(const nlohmann::ordered_json& event) {
  return event.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void WriteMore(int64_t all, size_t shown, const ProgramEnvironment& environment) {
  const int64_t more = all - static_cast<int64_t>(shown);
  if (more > 0) *environment.err << "  and " << more << " more\n";
}

void WriteBadLeaders(const batch::PlanCheck& check, const ProgramEnvironment& environment) {
  if (check.bad_leader_count == 0) return;
  *environment.err << base::Counted(check.bad_leader_count, "leader") << " cannot be used, of "
                   << base::Counted(check.items_of_bad_leaders, "item") << ":\n";
  for (const batch::BadLeader& leader : check.bad_leaders) {
    *environment.err << "  " << leader.message << " (" << base::Counted(leader.items, "item")
                     << ")\n";
  }
  WriteMore(check.bad_leader_count, check.bad_leaders.size(), environment);
}

std::vector<std::string> Problems(const batch::PlanCheck& check) {
  std::vector<std::string> problems = check.bad_lines;
  for (const batch::BadLeader& leader : check.bad_leaders) problems.push_back(leader.message);
  return problems;
}

// "  26 items of 1 leader: NOT_FOUND: no such file"
void WriteCauses(const std::vector<batch::FailureCause>& causes, std::ostream& out) {
  for (size_t i = 0; i < std::min(causes.size(), kCausesShown); ++i) {
    const batch::FailureCause& cause = causes[i];
    out << "  " << base::Counted(cause.items, "item");
    if (cause.leaders > 0) out << " of " << base::Counted(cause.leaders, "leader");
    out << ": " << cause.code << (cause.code.empty() ? "" : ": ") << cause.message << "\n";
  }
  if (causes.size() > kCausesShown) {
    out << "  and "
        << base::Counted(static_cast<int64_t>(causes.size() - kCausesShown), "other cause") << "\n";
  }
}

}  // namespace

void Report(const BatchArguments& arguments, const std::filesystem::path& folder,
            const batch::JobReport& report, bool failures_allowed,
            const ProgramEnvironment& environment) {
  const int64_t settled = report.set.done + report.set.rejected + report.set.failed;
  if (arguments.json) {
    const nlohmann::ordered_json event = {{"event", "end"},
                                          {"folder", folder.string()},
                                          {"planned", report.planned},
                                          {"done", report.set.done},
                                          {"rejected", report.set.rejected},
                                          {"failed", report.set.failed},
                                          {"failed_leaders", report.set.failed_leaders},
                                          {"missing", report.planned - settled},
                                          {"bytes", report.set.bytes},
                                          {"failures", ToJson(report.set.failures)},
                                          {"unfinished", ToJson(report.unfinished_causes)},
                                          {"stopped", std::string(report.stopped.message())}};
    *environment.out << Line(event) << "\n";
  } else if (!arguments.quiet) {
    *environment.out << folder.string() << ": " << report.set.done << " done, "
                     << report.set.rejected << " rejected, " << report.set.failed << " failed, "
                     << report.planned - settled << " missing\n";
  }
  if (arguments.json) return;
  if (report.planned == 0) {
    *environment.err << "duet: the plan has no items: the list of leaders is empty, or --limit, "
                        "--sample or --shard leaves none\n";
  }
  if (!report.set.failures.empty()) {
    *environment.err << "failed permanently, by leader in " << (folder / "failed.tsv").string()
                     << ":\n";
    WriteCauses(report.set.failures, *environment.err);
    if (failures_allowed) {
      *environment.err << "duet: --allow-failed permits the "
                       << base::Counted(report.set.failed_leaders, "leader") << " that failed\n";
    }
  }
  if (!report.unfinished_causes.empty()) {
    *environment.err << "failed temporarily; run the command again:\n";
    WriteCauses(report.unfinished_causes, *environment.err);
  }
}

void Report(const BatchArguments& arguments, const batch::PlanCheck& check,
            const batch::Estimate& estimate, const ProgramEnvironment& environment) {
  if (arguments.json) {
    const nlohmann::ordered_json event = {{"event", "estimate"},
                                          {"items", check.items},
                                          {"leaders", check.leaders},
                                          {"frames", check.frames},
                                          {"seconds", estimate.seconds},
                                          {"bytes", estimate.bytes},
                                          {"bad_lines", check.bad_line_count},
                                          {"bad_leaders", check.bad_leader_count},
                                          {"items_of_bad_leaders", check.items_of_bad_leaders},
                                          {"problems", Problems(check)}};
    *environment.out << Line(event) << "\n";
    return;
  }
  *environment.out << base::Counted(check.items, "item") << " of "
                   << base::Counted(check.leaders, "leader") << ", "
                   << base::Counted(check.frames, "frame");
  if (estimate.bytes > 0) {
    *environment.out << absl::StrFormat(": about %.0f s of calls one after the other, %.1f MB",
                                        estimate.seconds, estimate.bytes / 1e6);
  }
  *environment.out << "\n";
  if (check.bad_line_count > 0) {
    *environment.err << base::Counted(check.bad_line_count, "bad line") << ":\n";
    for (const std::string& line : check.bad_lines) *environment.err << "  " << line << "\n";
    WriteMore(check.bad_line_count, check.bad_lines.size(), environment);
  }
  WriteBadLeaders(check, environment);
}

void ReportBadLeaders(const BatchArguments& arguments, const batch::PlanCheck& check,
                      const ProgramEnvironment& environment) {
  if (check.bad_leader_count == 0) return;
  if (arguments.json) {
    const nlohmann::ordered_json event = {{"event", "bad_leaders"},
                                          {"bad_leaders", check.bad_leader_count},
                                          {"items_of_bad_leaders", check.items_of_bad_leaders},
                                          {"problems", Problems(check)}};
    *environment.out << Line(event) << "\n";
  } else {
    WriteBadLeaders(check, environment);
  }
}

void ReportGathered(const BatchArguments& arguments, const batch::Gathered& gathered,
                    const ProgramEnvironment& environment) {
  if (gathered.shards == 0 || arguments.quiet || arguments.json) return;
  *environment.err << "gathered " << gathered.shards << " of " << gathered.count << " shards, "
                   << base::Counted(gathered.items, "item") << "\n";
}

void ReportIndexedSides(const BatchArguments& arguments, const batch::IndexedSides& sides,
                        const ProgramEnvironment& environment) {
  const int64_t all = sides.left + sides.right + sides.unknown;
  if (all == 0 || arguments.quiet || arguments.json) return;
  *environment.err << "leaders by index.tsv: " << sides.left << " left, " << sides.right
                   << " right";
  if (sides.unknown > 0) *environment.err << ", " << sides.unknown << " unknown, read as left";
  *environment.err << "\n";
}

void ReportPassedOver(const BatchArguments& arguments, const std::vector<std::string>& files,
                      const ProgramEnvironment& environment) {
  if (files.empty() || arguments.quiet) return;
  *environment.err << "skipped, not a motion: " << files.front();
  if (files.size() > 1) *environment.err << " and " << files.size() - 1 << " more";
  *environment.err << "\n";
}

}  // namespace duet::client::cli
