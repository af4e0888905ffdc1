#ifndef DUET_SERVER_COMMON_ACTIVITY_H_
#define DUET_SERVER_COMMON_ACTIVITY_H_

#include <sys/types.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace duet::server::common {

// What the threads of this process are doing, for a watchdog. Everything here is atomic, because a
// stuck thread may hold any lock.

// A kind of step. It must live as long as the process: define it as a constexpr at namespace scope.
struct StepKind {
  const char* thread;  // "worker"
  const char* doing;   // "evaluating a batch"
  // Whether a thread that takes too long for it is stuck. False for work that waits for a file
  // system or another machine and delays no call.
  bool is_bounded = true;
};

// Marks a step of the calling thread's work, from construction to destruction. A nested step
// replaces the outer one until it ends. Costs a few stores.
//
//   const Step step(kEvaluating);
class Step {
 public:
  explicit Step(const StepKind& kind) : Step(&kind) {}
  ~Step();
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

 protected:
  explicit Step(const StepKind* kind);  // null: idle

 private:
  const StepKind* const outer_;
};

// Marks, within a step, that the calling thread waits for work: an idle thread is not stuck.
class Idle : private Step {
 public:
  Idle() : Step(nullptr) {}
};

// One thread as the watchdog sees it.
struct ThreadState {
  pid_t thread_id = 0;             // 0: no thread
  const StepKind* step = nullptr;  // null: idle
  std::uint64_t beat = 0;          // changes whenever a step begins or ends
};

// Maximum number of threads that are tracked at a time. Further threads run untracked.
inline constexpr std::size_t kMaxThreads = 2048;
using ThreadStates = std::array<ThreadState, kMaxThreads>;

// Copies the state of every thread that has begun a step and still runs. A thread keeps its index.
// Takes no lock and allocates no memory.
void ReadThreads(ThreadStates* states);

// Counters of the whole process.
struct Vitals {
  std::atomic<std::int64_t> calls{0};  // between their headers and their status
  std::atomic<std::int64_t> queued_windows{0};
  // Duration of the longest bounded step in progress. Set by the watchdog.
  std::atomic<double> longest_step_seconds{0};
};
Vitals& ProcessVitals();

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_ACTIVITY_H_
