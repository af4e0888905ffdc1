#include "server/common/background_thread.h"

#include <sys/resource.h>

#include <utility>

#include "server/common/clock.h"

namespace duet::server::common {
namespace {

// The kernel gives a thread of this niceness a ninth of the time of an ordinary one.
constexpr int kNiceness = 10;

}  // namespace

BackgroundThread::BackgroundThread(Share share) : thread_([this, share] { Work(share); }) {}

BackgroundThread::~BackgroundThread() {
  Stop();
  thread_.join();
}

void BackgroundThread::Post(std::function<void(bool run)> job) {
  {
    MutexLock lock(mutex_);
    if (!stopping_) {
      jobs_.push_back(std::move(job));
      changed_.NotifyOne();
      return;
    }
  }
  job(false);
}

void BackgroundThread::Stop() {
  std::deque<std::function<void(bool run)>> dropped;
  {
    MutexLock lock(mutex_);
    stopping_ = true;
    dropped.swap(jobs_);
    changed_.NotifyOne();
  }
  for (const auto& job : dropped) job(false);
}

bool BackgroundThread::stopping() const {
  MutexLock lock(mutex_);
  return stopping_;
}

void BackgroundThread::Work(Share share) {
  // Applies to this thread only: on Linux, 0 is the calling thread. If it is not permitted, the
  // thread runs like any other.
  if (share == Share::kSmall) setpriority(PRIO_PROCESS, 0, kNiceness);
  while (true) {
    std::function<void(bool run)> job;
    {
      MutexLock lock(mutex_);
      while (jobs_.empty() && !stopping_) changed_.Wait(mutex_);
      if (stopping_) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    job(true);
  }
}

RepeatedTask::RepeatedTask(double pause_seconds, std::function<void()> task)
    : thread_([this, pause_seconds, task = std::move(task)] { Run(pause_seconds, task); }) {}

RepeatedTask::~RepeatedTask() {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.NotifyAll();
  thread_.join();
}

void RepeatedTask::Run(double pause_seconds, const std::function<void()>& task) {
  while (true) {
    {
      MutexLock lock(mutex_);
      const auto end = std::chrono::steady_clock::now() + Seconds(pause_seconds);
      while (!stopping_ && changed_.WaitUntil(mutex_, end)) {
      }
      if (stopping_) return;
    }
    task();
  }
}

}  // namespace duet::server::common
