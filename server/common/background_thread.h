#ifndef DUET_SERVER_COMMON_BACKGROUND_THREAD_H_
#define DUET_SERVER_COMMON_BACKGROUND_THREAD_H_

#include <deque>
#include <functional>
#include <thread>

#include "server/common/mutex.h"

namespace duet::server::common {

// Runs jobs one after the other on a thread of its own.
//
// Threads: safe to call concurrently.
class BackgroundThread {
 public:
  enum class Share {
    kSmall,     // about a tenth of a core while all cores are busy with calls
    kOrdinary,  // like any other thread
  };

  explicit BackgroundThread(Share share);
  // Waits for the running job and calls the jobs that have not begun with false.
  ~BackgroundThread();
  BackgroundThread(const BackgroundThread&) = delete;
  BackgroundThread& operator=(const BackgroundThread&) = delete;

  // Calls the job once: `job(true)` on this thread at its turn, or `job(false)` on any thread if it
  // will not run.
  void Post(std::function<void(bool run)> job);

  // Prevents further jobs from starting. Does not wait.
  void Stop();
  // Whether Stop was called. For long jobs.
  bool stopping() const;

 private:
  void Work(Share share);

  mutable Mutex mutex_;
  CondVar changed_;
  std::deque<std::function<void(bool run)>> jobs_ DUET_GUARDED_BY(mutex_);
  bool stopping_ DUET_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

// Runs a task repeatedly on a thread of its own, with a pause in between, until destroyed.
class RepeatedTask {
 public:
  RepeatedTask(double pause_seconds, std::function<void()> task);
  // Waits for a task that is running.
  ~RepeatedTask();

 private:
  void Run(double pause_seconds, const std::function<void()>& task);

  Mutex mutex_;
  CondVar changed_;
  bool stopping_ DUET_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_BACKGROUND_THREAD_H_
