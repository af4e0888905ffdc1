#include "server/lifecycle/repeated_task.h"

#include <chrono>
#include <utility>

namespace duet::server::lifecycle {

RepeatedTask::RepeatedTask(double pause_seconds, std::function<void()> task)
    : thread_([this, pause_seconds, task = std::move(task)] { Run(pause_seconds, task); }) {}

RepeatedTask::~RepeatedTask() {
  {
    common::MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.NotifyAll();
  thread_.join();
}

void RepeatedTask::Run(double pause_seconds, const std::function<void()>& task) {
  const auto pause = std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(pause_seconds));
  while (true) {
    {
      common::MutexLock lock(mutex_);
      const auto end = std::chrono::steady_clock::now() + pause;
      while (!stopping_ && changed_.WaitUntil(mutex_, end)) {
      }
      if (stopping_) return;
    }
    task();
  }
}

}  // namespace duet::server::lifecycle
