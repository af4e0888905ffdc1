#include "client/cli/batch_progress.h"

#include <algorithm>
#include <ostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

int64_t ItemsOfRun(const batch::Progress& progress) {
  return progress.done + progress.rejected + progress.failed + progress.unfinished;
}

double Rate(const batch::Progress& progress, double seconds) {
  return seconds > 0 ? static_cast<double>(ItemsOfRun(progress)) / seconds : 0;
}

std::optional<double> SecondsLeft(const batch::Progress& progress, int64_t total, double seconds) {
  const double rate = Rate(progress, seconds);
  if (rate <= 0) return std::nullopt;
  const int64_t left = total - progress.resumed - ItemsOfRun(progress);
  return static_cast<double>(std::max<int64_t>(left, 0)) / rate;
}

std::string Clock(double seconds) {
  const auto whole = static_cast<int64_t>(seconds + 0.5);
  if (whole < 3600) return absl::StrFormat("%d:%02d", whole / 60, whole % 60);
  return absl::StrFormat("%d:%02d:%02d", whole / 3600, whole / 60 % 60, whole % 60);
}

void AddCount(const char* what, int64_t count, std::string* line) {
  if (count > 0) absl::StrAppend(line, ", ", count, " ", what);
}

}  // namespace

std::string ProgressLine(const batch::Progress& progress, int64_t total, double seconds) {
  std::string line = absl::StrCat(progress.resumed + ItemsOfRun(progress), " of ", total);
  absl::StrAppendFormat(&line, " items, %.1f a second", Rate(progress, seconds));
  if (const auto left = SecondsLeft(progress, total, seconds); left.has_value()) {
    absl::StrAppend(&line, ", ", Clock(*left), " left");
  }
  absl::StrAppend(&line, ", ", progress.calls.in_flight, " of ", progress.calls.limit,
                  " calls at once");
  AddCount("refusals", progress.calls.refusals, &line);
  AddCount("rejected", progress.rejected, &line);
  AddCount("failed", progress.failed, &line);
  AddCount("unfinished", progress.unfinished, &line);
  return line;
}

std::string ProgressEvent(const batch::Progress& progress, int64_t total, double seconds) {
  nlohmann::ordered_json event = {{"event", "progress"},
                                  {"seconds", seconds},
                                  {"resumed", progress.resumed},
                                  {"done", progress.done},
                                  {"rejected", progress.rejected},
                                  {"failed", progress.failed},
                                  {"unfinished", progress.unfinished},
                                  {"bytes", progress.bytes},
                                  {"in_flight", progress.calls.in_flight},
                                  {"window", progress.calls.limit},
                                  {"refusals", progress.calls.refusals},
                                  {"total", total}};
  if (const auto left = SecondsLeft(progress, total, seconds); left.has_value()) {
    event["seconds_left"] = *left;
  }
  return event.dump() + "\n";
}

ProgressDisplay::ProgressDisplay(Kind kind, const batch::Job& job, int64_t total, std::ostream& out)
    : kind_(kind), job_(job), total_(total), out_(out) {
  if (kind != Kind::kNone) shower_ = std::thread([this] { ShowUntilEnd(); });
}

ProgressDisplay::~ProgressDisplay() {
  if (kind_ == Kind::kNone) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    end_ = true;
  }
  ended_.notify_all();
  shower_.join();
  Show();
  if (kind_ == Kind::kTerminal) out_ << "\n" << std::flush;
}

void ProgressDisplay::Show() {
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const batch::Progress progress = job_.progress();
  if (kind_ == Kind::kEvents) {
    out_ << ProgressEvent(progress, total_, seconds) << std::flush;
  } else if (kind_ == Kind::kTerminal) {
    // Returns to the start of the line, and clears the rest of the previous text.
    out_ << "\r" << ProgressLine(progress, total_, seconds) << "\x1b[K" << std::flush;
  } else {
    out_ << ProgressLine(progress, total_, seconds) << "\n" << std::flush;
  }
}

void ProgressDisplay::ShowUntilEnd() {
  const std::chrono::milliseconds interval(kind_ == Kind::kTerminal ? 200
                                           : kind_ == Kind::kEvents ? 1000
                                                                    : 10000);
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ended_.wait_for(lock, interval, [this] { return end_; })) Show();
}

}  // namespace duet::client::cli
