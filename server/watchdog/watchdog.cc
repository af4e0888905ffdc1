#include "server/watchdog/watchdog.h"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cinttypes>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>

#include "server/watchdog/exit_codes.h"

namespace duet::server::watchdog {
namespace {

// For a process that can no longer trust its heap, its locks or its log: it writes a few lines and
// exits.

// One line of the log (json_log.h), formatted without allocating memory.
//
//   LastLine line(/*text=*/false, "thread_stuck");
//   line.Add("thread", "worker");
//   line.Write(STDERR_FILENO);
class LastLine {
 public:
  // `event`, keys and texts are plain ASCII without quotes or backslashes. Fields that do not fit
  // are omitted.
  LastLine(bool text, const char* event);
  void Add(const char* key, const char* value);
  void Add(const char* key, std::int64_t value);
  void Add(const char* key, double seconds);

  // Ends the line and writes it to a descriptor. Blocks until the reader takes it. Call once.
  void Write(int descriptor);

 private:
  void Append(const char* format, ...) __attribute__((format(printf, 2, 3)));

  const bool text_;
  std::size_t size_ = 0;
  bool is_full_ = false;
  // The size that a pipe writes atomically, so that no other line is mixed in.
  char bytes_[4096];
};

constexpr std::size_t kEnd = 3;  // "}\n" and the terminator

std::atomic<int> alarm_exit_code{0};

void Exit(int) { _exit(alarm_exit_code); }

LastLine::LastLine(bool text, const char* event) : text_(text) {
  bytes_[0] = '\0';
  timespec now = {};
  clock_gettime(CLOCK_REALTIME, &now);
  tm utc = {};
  gmtime_r(&now.tv_sec, &utc);
  char time[32];
  std::strftime(time, sizeof(time), "%Y-%m-%dT%H:%M:%S", &utc);
  const long microseconds = now.tv_nsec / 1000;
  if (text_) {
    Append("%s.%06ldZ ERROR   %s", time, microseconds, event);
  } else {
    Append(R"({"time":"%s.%06ldZ","severity":"ERROR","event":"%s")", time, microseconds, event);
  }
}

void LastLine::Append(const char* format, ...) {
  if (is_full_) return;
  const std::size_t room = sizeof(bytes_) - kEnd - size_;
  va_list values;
  va_start(values, format);
  const int length = std::vsnprintf(bytes_ + size_, room, format, values);
  va_end(values);
  if (length < 0 || static_cast<std::size_t>(length) >= room) {
    bytes_[size_] = '\0';
    is_full_ = true;
    return;
  }
  size_ += static_cast<std::size_t>(length);
}

void LastLine::Add(const char* key, const char* value) {
  if (text_ && std::strchr(value, ' ') == nullptr) {
    Append(" %s=%s", key, value);
  } else {
    Append(text_ ? R"( %s="%s")" : R"(,"%s":"%s")", key, value);
  }
}

void LastLine::Add(const char* key, std::int64_t value) {
  Append(text_ ? " %s=%" PRId64 : ",\"%s\":%" PRId64, key, value);
}

void LastLine::Add(const char* key, double seconds) {
  Append(text_ ? " %s=%.1f" : ",\"%s\":%.1f", key, seconds);
}

void LastLine::Write(int descriptor) {
  std::memcpy(bytes_ + size_, text_ ? "\n" : "}\n", text_ ? 2 : 3);
  size_ += text_ ? 1 : 2;
  for (std::size_t done = 0; done < size_;) {
    const ssize_t written = write(descriptor, bytes_ + done, size_ - done);
    if (written < 0 && errno != EINTR) return;
    if (written > 0) done += static_cast<std::size_t>(written);
  }
}

// Makes the process exit with `exit_code` after `seconds`, even if the calling thread blocks
// forever on the log or on a lock. Uses SIGALRM, which no other use may block.
void EndWithin(unsigned seconds, int exit_code) {
  alarm_exit_code = exit_code;
  struct sigaction action = {};
  action.sa_handler = Exit;
  sigaction(SIGALRM, &action, nullptr);
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGALRM);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  alarm(seconds);
}

using std::chrono::steady_clock;

// The pause between two checks lies between these.
constexpr double kLongestPause = 1;
constexpr double kShortestPause = 0.01;
// Checks within the maximum duration of a step.
constexpr double kLooks = 8;
// The pause while the process stops.
constexpr double kPauseWhileStopping = 0.1;
// Timeout for writing all last lines.
constexpr unsigned kLastSeconds = 3;
// Maximum number of threads that get a line.
constexpr int kMaxLines = 16;
sigset_t WatchedSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, signal);
  return signals;
}

// Returns the signal that arrived within `seconds`, or 0.
int WaitForSignal(double seconds) {
  const sigset_t signals = WatchedSignals();
  timespec timeout = {};
  timeout.tv_sec = static_cast<time_t>(seconds);
  timeout.tv_nsec =
      static_cast<decltype(timeout.tv_nsec)>((seconds - static_cast<double>(timeout.tv_sec)) * 1e9);
  return std::max(0, sigtimedwait(&signals, nullptr, &timeout));
}

}  // namespace

Watchdog::Watchdog(const WatchdogOptions& options, StopSignal& stop)
    : options_(options), stop_(stop), stop_seconds_(options.hurry_seconds) {
  tzset();  // allocates memory at its first use
  thread_ = std::thread([this] { Run(); });
}

Watchdog::~Watchdog() {
  ended_ = true;
  pthread_kill(thread_.native_handle(), SIGHUP);  // wakes it; the signal is blocked everywhere
  thread_.join();
}

void Watchdog::Run() {
  pthread_setname_np(pthread_self(), "watchdog");
  steady_clock::time_point last = steady_clock::now();
  while (true) {
    const double pause = PauseSeconds();
    const int signal = WaitForSignal(pause);
    if (ended_) return;
    if (signal != 0) Take(signal);
    const steady_clock::time_point now = steady_clock::now();
    // A longer time means that this thread did not run, and perhaps no other thread did.
    Look(std::min(std::chrono::duration<double>(now - last).count(), 2 * pause));
    last = now;
  }
}

double Watchdog::PauseSeconds() const {
  double pause = kLongestPause;
  if (options_.step_seconds > 0) {
    pause = std::clamp(options_.step_seconds / kLooks, kShortestPause, kLongestPause);
  }
  return deadline_.asked() ? std::min(pause, kPauseWhileStopping) : pause;
}

void Watchdog::Take(int signal) {
  if (signal == SIGHUP) {
    stop_.Note(StopSignal::Kind::kReload);
    return;
  }
  deadline_.Asked();
  stop_.Note(StopSignal::Kind::kStop);
}

void Watchdog::Look(double elapsed) {
  common::ReadThreads(&threads_);
  watch_.Look(threads_, elapsed);
  deadline_.Pass(elapsed);
  const double longest = watch_.longest().seconds;
  common::ProcessVitals().longest_step_seconds = longest;
  if (options_.step_seconds > 0 && longest > options_.step_seconds) EndStuck();
  if (deadline_.IsOver(stop_seconds_, options_.hurry_seconds)) EndLate();
}

void Watchdog::EndStuck() {
  EndWithin(kLastSeconds, kExitStuck);
  int lines = 0;
  watch_.ForEach(options_.step_seconds, /*every=*/false, [&](const BusyThread& thread) {
    if (lines++ < kMaxLines) WriteThread("thread_stuck", thread);
  });
  LastLine line(options_.text_log, "stuck");
  line.Add("message", "a thread makes no progress; the process ends so that it is started again");
  line.Add("threads", std::int64_t{lines});
  line.Add("watchdog_seconds", options_.step_seconds);
  line.Add("calls", common::ProcessVitals().calls.load());
  line.Add("queued_windows", common::ProcessVitals().queued_windows.load());
  line.Add("exit_code", std::int64_t{kExitStuck});
  line.Write(STDERR_FILENO);
  _exit(kExitStuck);
}

void Watchdog::EndLate() {
  EndWithin(kLastSeconds, kExitLate);
  int lines = 0;
  watch_.ForEach(0, /*every=*/true, [&](const BusyThread& thread) {
    if (lines++ < kMaxLines) WriteThread("thread_at_work", thread);
  });
  LastLine line(options_.text_log, "stopped_late");
  line.Add("message", "asked to stop, and did not end in time; the process ends as it is");
  line.Add("threads", std::int64_t{lines});
  line.Add("calls", common::ProcessVitals().calls.load());
  line.Add("queued_windows", common::ProcessVitals().queued_windows.load());
  line.Add("exit_code", std::int64_t{kExitLate});
  line.Write(STDERR_FILENO);
  _exit(kExitLate);
}

void Watchdog::WriteThread(const char* event, const BusyThread& thread) {
  LastLine line(options_.text_log, event);
  line.Add("thread", thread.step->thread);
  line.Add("thread_id", std::int64_t{thread.thread_id});
  line.Add("doing", thread.step->doing);
  line.Add("seconds", thread.seconds);
  line.Write(STDERR_FILENO);
}

}  // namespace duet::server::watchdog
