#include "server/watchdog/watchdog.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "server/watchdog/exit_codes.h"
#include "server/watchdog/last_words.h"
#include "server/watchdog/thread_stack.h"

namespace duet::server::watchdog {
namespace {

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
// Timeout for reading the stack of one thread. On a busy machine a thread that could respond may
// not run for a while, so threads share some more time.
constexpr std::chrono::milliseconds kStackPatience(50);
constexpr std::chrono::milliseconds kSharedPatience(1500);
static_assert(kMaxLines * kStackPatience + kSharedPatience < std::chrono::seconds(kLastSeconds));

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
    : options_(options),
      stop_(stop),
      stop_seconds_(options.hurry_seconds),
      shared_patience_(kSharedPatience) {
  // Use now what allocates memory at its first use.
  PrepareThreadStacks();
  tzset();
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
  char stack[2048];
  const steady_clock::time_point begin = steady_clock::now();
  WriteThreadStack(thread.thread_id, kStackPatience + shared_patience_, stack, sizeof(stack));
  const auto used = std::chrono::ceil<std::chrono::milliseconds>(steady_clock::now() - begin);
  shared_patience_ -=
      std::clamp(used - kStackPatience, std::chrono::milliseconds(0), shared_patience_);
  LastLine line(options_.text_log, event);
  line.Add("thread", thread.step->thread);
  line.Add("thread_id", std::int64_t{thread.thread_id});
  line.Add("doing", thread.step->doing);
  line.Add("seconds", thread.seconds);
  if (stack[0] != '\0') line.Add("stack", stack);
  line.Write(STDERR_FILENO);
}

}  // namespace duet::server::watchdog
