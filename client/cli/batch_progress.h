#ifndef DUET_CLIENT_CLI_BATCH_PROGRESS_H_
#define DUET_CLIENT_CLI_BATCH_PROGRESS_H_

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "client/batch/job.h"

namespace duet::client::cli {

// One line about how far a run is: items, rate, time left, refusals and failures.
std::string ProgressLine(const batch::Progress& progress, int64_t total, double seconds);
// The same as a JSON line {"event": "progress", ...}.
std::string ProgressEvent(const batch::Progress& progress, int64_t total, double seconds);

// Shows the progress of a run while it lives: in place on a terminal, else a line every ten
// seconds, as an event every second.
class ProgressDisplay {
 public:
  enum class Kind { kNone, kTerminal, kLines, kEvents };
  // `total`: items that the run makes or has. Job and stream outlive the display.
  ProgressDisplay(Kind kind, const batch::Job& job, int64_t total, std::ostream& out);
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;
  ~ProgressDisplay();

 private:
  void ShowUntilEnd();
  void Show();

  Kind kind_;
  const batch::Job& job_;
  const int64_t total_;
  std::ostream& out_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread shower_;
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_PROGRESS_H_
