#ifndef DUET_TESTS_SERVER_SUPPORT_RECORDING_OBSERVER_H_
#define DUET_TESTS_SERVER_SUPPORT_RECORDING_OBSERVER_H_

#include <cstddef>
#include <vector>

#include "server/common/mutex.h"
#include "server/metrics/call_record.h"

namespace duet {

// Remembers every finished call.
//
// Threads: safe to call concurrently.
class RecordingObserver final : public CallObserver {
 public:
  void CallStarted(const MethodInfo&) override {
    MutexLock lock(mutex_);
    ++started_;
  }
  void CallFinished(const CallRecord& record) override {
    MutexLock lock(mutex_);
    records_.push_back(record);
    changed_.NotifyAll();
  }

  std::size_t started() const {
    MutexLock lock(mutex_);
    return started_;
  }
  std::vector<CallRecord> records() const {
    MutexLock lock(mutex_);
    return records_;
  }
  // Waits until so many calls are over; returns the last of them.
  CallRecord WaitFor(std::size_t count) {
    MutexLock lock(mutex_);
    while (records_.size() < count) changed_.Wait(mutex_);
    return records_[count - 1];
  }

 private:
  mutable Mutex mutex_;
  CondVar changed_;
  std::size_t started_ DUET_GUARDED_BY(mutex_) = 0;
  std::vector<CallRecord> records_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet

#endif  // DUET_TESTS_SERVER_SUPPORT_RECORDING_OBSERVER_H_
