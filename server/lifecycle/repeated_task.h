#ifndef DUET_SERVER_LIFECYCLE_REPEATED_TASK_H_
#define DUET_SERVER_LIFECYCLE_REPEATED_TASK_H_

#include <functional>
#include <thread>

#include "server/common/mutex.h"

namespace duet::server::lifecycle {

// Runs a task repeatedly on a thread of its own, with a pause in between, until destroyed.
class RepeatedTask {
 public:
  RepeatedTask(double pause_seconds, std::function<void()> task);
  // Waits for a task that is running.
  ~RepeatedTask();

 private:
  void Run(double pause_seconds, const std::function<void()>& task);

  common::Mutex mutex_;
  common::CondVar changed_;
  bool stopping_ DUET_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_REPEATED_TASK_H_
