#ifndef DUET_CLIENT_CLI_LIVE_REPORT_H_
#define DUET_CLIENT_CLI_LIVE_REPORT_H_

#include <mutex>
#include <ostream>
#include <string>

#include "absl/time/time.h"
#include "client/live/live_run.h"

namespace duet::client::cli {

// "12.3 s, 362 frames, latency p50 2.1 ms, p99 8.0 ms, gaps 3, late 0, skipped 0"
std::string ProgressLine(const live::LiveProgress& progress);

// The summary of a run, for people and for programs.
std::string DescribeLive(const live::LiveReport& report);
std::string LiveJson(const live::LiveReport& report);

// The line of a run on a terminal, redrawn in place, and lines above it. Safe to call concurrently.
class LiveStrip {
 public:
  enum class Kind { kNone, kLinesOnly, kTerminal };
  LiveStrip(Kind kind, std::ostream& err) : kind_(kind), err_(err) {}

  // Redraws at most four times a second.
  void Show(const live::LiveProgress& progress);
  // Prints what a source does.
  void Show(const std::string& note);
  // Prints what happened to the connection.
  void Show(const LiveNotice& notice);
  // Ends the line. Nothing may follow.
  void End();

 private:
  void Print(const std::string& line);

  const Kind kind_;
  std::ostream& err_;
  std::mutex mutex_;
  absl::Time shown_ = absl::InfinitePast();
  std::string line_;  // on the screen
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_LIVE_REPORT_H_
