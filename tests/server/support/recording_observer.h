#ifndef DUET_TESTS_SERVER_SUPPORT_RECORDING_OBSERVER_H_
#define DUET_TESTS_SERVER_SUPPORT_RECORDING_OBSERVER_H_

#include <cstddef>
#include <vector>

#include "server/common/mutex.h"
#include "server/metrics/call_record.h"

namespace duet::test {

// Records every finished call.
//
// Threads: safe to call concurrently.
class RecordingObserver final : public server::metrics::CallObserver {
 public:
  void CallStarted(const server::metrics::MethodInfo&) override {
    server::common::MutexLock lock(mutex_);
    ++started_;
  }
  void CallFinished(const server::metrics::CallRecord& record) override {
    server::common::MutexLock lock(mutex_);
    records_.push_back(record);
    changed_.NotifyAll();
  }

  std::size_t started() const {
    server::common::MutexLock lock(mutex_);
    return started_;
  }
  std::vector<server::metrics::CallRecord> records() const {
    server::common::MutexLock lock(mutex_);
    return records_;
  }
  // Waits until that many calls have finished. Returns the last of them.
  server::metrics::CallRecord WaitFor(std::size_t count) {
    server::common::MutexLock lock(mutex_);
    while (records_.size() < count) changed_.Wait(mutex_);
    return records_[count - 1];
  }

 private:
  mutable server::common::Mutex mutex_;
  server::common::CondVar changed_;
  std::size_t started_ DUET_GUARDED_BY(mutex_) = 0;
  std::vector<server::metrics::CallRecord> records_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_RECORDING_OBSERVER_H_
