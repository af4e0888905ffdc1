#ifndef DUET_SERVER_LIFECYCLE_PROCESS_END_H_
#define DUET_SERVER_LIFECYCLE_PROCESS_END_H_

#include <malloc.h>

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <functional>
#include <string>
#include <utility>

namespace duet::server::lifecycle {

// Exit codes of duet-server.
inline constexpr int kExitStopped = 0;  // drained after SIGTERM or SIGINT, or nothing to report
inline constexpr int kExitFailed = 1;   // a file, address or model that settings name is invalid
inline constexpr int kExitUsage = 2;    // a flag or the configuration file is invalid
inline constexpr int kExitStuck = 3;    // no self-check succeeded for watchdog_seconds
inline constexpr int kExitLate = 4;     // did not exit in time after a signal to stop

// Ends the process if a time passes. A timer of the kernel does it, whose signal (SIGALRM) writes
// one line to standard error and exits: a thread that hangs may hold any lock, also those of the
// heap and the log, or be the one that would stop the process. The clock runs while the process is
// paused.
class LastResort {
 public:
  // The line is {"severity":"ERROR","event":EVENT,"message":MESSAGE,"exit_code":CODE}: texts
  // without quotes.
  LastResort(const std::string& event, const std::string& message, int exit_code);
  ~LastResort();
  LastResort(const LastResort&) = delete;
  LastResort& operator=(const LastResort&) = delete;

  // Ends the process in `seconds` from now, unless it is called again before; 0: never. May be
  // called by a signal's handler.
  void Set(double seconds);

 private:
  static void End(int, siginfo_t* info, void*);

  const std::string line_;
  const int exit_code_;
  timer_t timer_ = {};
};

// Signals that the main thread has not handled yet: SIGTERM and SIGINT stop the server, SIGHUP
// reloads. From a signal to stop on, the process has the time of AllowToStop to exit, and
// kHurrySeconds from the second one; afterwards it ends as it is, with kExitLate. Both hold even if
// the main thread hangs.
//
// At most one exists at a time. One thread waits.
class StopSignal {
 public:
  enum class Kind { kStop, kReload };

  // Maximum time to exit when no call is left: gRPC sends statuses for a second; a running
  // self-check and a stuck log take at most five seconds each.
  static constexpr double kHurrySeconds = 10;

  StopSignal();
  // Restores the default action of the signals, like Release.
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  // For a process that does not drain.
  void Release();
  // The default is kHurrySeconds.
  void AllowToStop(double seconds);

  // Waits for a signal and returns its kind. A stop is returned before a reload; reloads that are
  // not handled yet count as one.
  Kind Wait();
  // Waits at most `seconds` for a stop and returns whether it arrived; 0 only checks. A reload that
  // arrives meanwhile is left for Wait.
  bool WaitFor(double seconds);

 private:
  LastResort late_;
};

// Makes the heap return freed memory to the system. Call it before other threads start.
//
// By default glibc adapts its mmap threshold to the sizes that it has seen freed, and with it the
// amount that may stay free at the end of each thread's heap, up to 64 MiB; HeapTrimmer cannot
// release that part. The memory of a server would then depend on which thread served which request.
// glibc also allows eight heaps for each core, each with partly used pages; this function allows
// two.
void LimitFreeMemory();

// Returns the memory of large requests to the system. glibc keeps freed memory, above all free
// pages between blocks that are still in use: after a burst of large requests it would keep
// hundreds of megabytes forever.
//
// Threads: not safe to call concurrently.
class HeapTrimmer {
 public:
  // `trim` replaces malloc_trim, for tests.
  explicit HeapTrimmer(std::function<void()> trim = [] { malloc_trim(0); })
      : trim_(std::move(trim)) {}

  // Call it about once a second with the bytes of all large requests so far and the bytes that
  // calls hold now. Trims if large requests arrived or finished, and once more at the next call,
  // because the memory of the last request is freed a little later.
  void Look(std::uint64_t received_bytes, std::size_t held_bytes);

 private:
  const std::function<void()> trim_;
  std::uint64_t received_bytes_ = 0;
  std::size_t held_bytes_ = 0;
  bool once_more_ = false;
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_PROCESS_END_H_
