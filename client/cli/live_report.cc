#include "client/cli/live_report.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/time/time.h"
#include "client/cli/report.h"
#include "model/base/counted.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

std::string Describe(const live::Latencies& latency) {
  return absl::StrFormat("p50 %.1f ms, p99 %.1f ms", absl::ToDoubleMilliseconds(latency.p50),
                         absl::ToDoubleMilliseconds(latency.p99));
}

// What went wrong, in words; empty if nothing did.
std::string DescribeLosses(const live::LiveTotals& totals) {
  std::vector<std::string> parts;
  if (totals.gap_frames > 0) {
    parts.push_back(
        absl::StrCat(base::Counted(totals.gap_frames, "missing leader frame"), " interpolated"));
  }
  if (totals.late_frames > 0) {
    parts.push_back(
        absl::StrCat(base::Counted(totals.late_frames, "late leader frame"), " dropped"));
  }
  if (totals.skipped_frames > 0) {
    parts.push_back(absl::StrCat(base::Counted(totals.skipped_frames, "follower frame"),
                                 " from an older plan, because the server could not keep up"));
  }
  return absl::StrJoin(parts, "; ");
}

}  // namespace

std::string DescribeLive(const live::LiveReport& report) {
  const live::LiveTotals& totals = report.totals;
  std::string text;
  for (const std::string& note : report.notes) absl::StrAppend(&text, "note      ", note, "\n");
  absl::StrAppend(&text, "model     ", report.info.model_name, "@", report.info.model_version,
                  ", seed ", report.info.seed, ", delay ",
                  base::Counted(report.info.delay_frames, "frame"), "\n");
  absl::StrAppendFormat(&text, "live      %.1f s, %d follower frames at %g Hz\n",
                        absl::ToDoubleSeconds(totals.time), totals.frames, report.frame_rate_hz);
  absl::StrAppend(&text, "latency   ", Describe(totals.latency), "\n");
  const std::string losses = DescribeLosses(totals);
  if (!losses.empty()) absl::StrAppend(&text, "losses    ", losses, "\n");
  if (totals.resumed > 0) {
    absl::StrAppend(&text, "resumed   ", base::Counted(totals.resumed, "time"),
                    ", without losing a frame\n");
  }
  for (const std::string& line : report.written) absl::StrAppend(&text, "wrote     ", line, "\n");
  return text;
}

std::string LiveJson(const live::LiveReport& report) {
  const live::LiveTotals& totals = report.totals;
  return Print({{"model", report.info.model_name},
                {"model_version", report.info.model_version},
                {"seed", report.info.seed},
                {"variety", report.info.variety},
                {"candidates", report.info.candidates},
                {"cleaned_up", report.info.cleaned_up},
                {"delay_frames", report.info.delay_frames},
                {"request_id", report.info.request_id},
                {"frame_rate_hz", report.frame_rate_hz},
                {"seconds", absl::ToDoubleSeconds(totals.time)},
                {"leader_frames", report.leader_frames},
                {"follower_frames", totals.frames},
                {"gap_frames", totals.gap_frames},
                {"late_frames", totals.late_frames},
                {"skipped_frames", totals.skipped_frames},
                {"resumed", totals.resumed},
                {"latency_ms",
                 {{"p50", absl::ToDoubleMilliseconds(totals.latency.p50)},
                  {"p99", absl::ToDoubleMilliseconds(totals.latency.p99)}}},
                {"notes", report.notes},
                {"written", report.written}});
}

}  // namespace duet::client::cli
