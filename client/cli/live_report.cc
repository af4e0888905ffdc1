#include "client/cli/live_report.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/time/clock.h"
#include "client/cli/report.h"
#include "model/base/counted.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

constexpr absl::Duration kRedrawPeriod = absl::Milliseconds(250);

std::string Describe(const live::Latencies& latency) {
  return absl::StrFormat("p50 %.1f ms, p99 %.1f ms", absl::ToDoubleMilliseconds(latency.p50),
                         absl::ToDoubleMilliseconds(latency.p99));
}

// What went wrong, in words; empty if nothing did.
std::string DescribeLosses(const live::LiveProgress& totals) {
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

std::string ProgressLine(const live::LiveProgress& progress) {
  std::string line = absl::StrFormat("%.1f s, %d frames, latency %s, gaps %d, late %d, skipped %d",
                                     absl::ToDoubleSeconds(progress.time), progress.frames,
                                     Describe(progress.latency), progress.gap_frames,
                                     progress.late_frames, progress.skipped_frames);
  if (progress.resumed > 0) absl::StrAppend(&line, ", resumed ", progress.resumed);
  return line;
}

std::string DescribeLive(const live::LiveReport& report) {
  const live::LiveProgress& totals = report.totals;
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
  const live::LiveProgress& totals = report.totals;
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

void LiveStrip::Show(const live::LiveProgress& progress) {
  if (kind_ != Kind::kTerminal) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  const absl::Time now = absl::Now();
  if (now - shown_ < kRedrawPeriod) return;
  shown_ = now;
  line_ = ProgressLine(progress);
  // Returns to the start of the line, and clears the rest of the previous text.
  err_ << "\r" << line_ << "\x1b[K" << std::flush;
}

void LiveStrip::Show(const LiveNotice& notice) {
  switch (notice.kind) {
    case LiveNotice::Kind::kDraining:
      return Print("duet: the server shuts down; moving to another one");
    case LiveNotice::Kind::kInterrupted:
      return Print(absl::StrCat("duet: ", notice.message, "; resuming"));
    case LiveNotice::Kind::kResumed:
      return Print("duet: resumed");
    default:  // counted
      return;
  }
}

void LiveStrip::Show(const std::string& note) { Print(absl::StrCat("duet: ", note)); }

void LiveStrip::Print(const std::string& line) {
  if (kind_ == Kind::kNone) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!line_.empty()) err_ << "\r\x1b[K";
  err_ << line << "\n" << line_ << std::flush;
}

void LiveStrip::End() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!line_.empty()) err_ << "\n" << std::flush;
  line_.clear();
}

}  // namespace duet::client::cli
