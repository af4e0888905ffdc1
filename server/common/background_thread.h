#ifndef DUET_SERVER_COMMON_BACKGROUND_THREAD_H_
#define DUET_SERVER_COMMON_BACKGROUND_THREAD_H_

#include <deque>
#include <functional>
#include <thread>

#include "server/common/mutex.h"

namespace duet::server::common {

// A thread that does one job after the other, so that whoever has the job need not.
//
// Threads: safe to call concurrently.
class BackgroundThread {
 public:
  enum class Share {
    kSmall,     // of processors that are all busy answering calls, about a tenth of one
    kOrdinary,  // as any other thread
  };

  explicit BackgroundThread(Share share);
  // Waits for the job under way; those that were not begun are told.
  ~BackgroundThread();
  BackgroundThread(const BackgroundThread&) = delete;
  BackgroundThread& operator=(const BackgroundThread&) = delete;

  // Calls `job(true)` when its turn comes, or `job(false)` when it never will, on whatever thread:
  // once.
  void Post(std::function<void(bool run)> job);

  // Begins no further job. Does not wait.
  void Stop();
  // Whether Stop was called: for jobs that take long.
  bool stopping() const;

 private:
  void Work(Share share);

  mutable Mutex mutex_;
  CondVar changed_;
  std::deque<std::function<void(bool run)>> jobs_ DUET_GUARDED_BY(mutex_);
  bool stopping_ DUET_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_BACKGROUND_THREAD_H_
