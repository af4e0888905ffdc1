#ifndef DUET_TESTS_SERVER_SUPPORT_FAKES_H_
#define DUET_TESTS_SERVER_SUPPORT_FAKES_H_

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <vector>

#include "server/common/clock.h"
#include "server/common/mutex.h"
#include "server/metrics/call_record.h"
#include "tests/support/fake_synthesizer.h"

namespace duet::test {

// Threads: every class in this file is safe to call concurrently.

// A clock that only the test advances.
class FakeClock final : public server::common::Clock {
 public:
  server::common::TimePoint Now() const override { return server::common::TimePoint(now_.load()); }
  void Advance(std::chrono::milliseconds by) { now_ = now_.load() + by; }

 private:
  std::atomic<server::common::TimePoint::duration> now_{std::chrono::hours(1)};
};

// Holds up every thread that passes until the test opens it.
class Gate {
 public:
  void Pass() {
    server::common::MutexLock lock(mutex_);
    ++reached_;
    changed_.NotifyAll();
    while (!open_) changed_.Wait(mutex_);
  }
  void WaitUntilReached(int count = 1) {
    server::common::MutexLock lock(mutex_);
    while (reached_ < count) changed_.Wait(mutex_);
  }
  void Open() {
    server::common::MutexLock lock(mutex_);
    open_ = true;
    changed_.NotifyAll();
  }
  // Number of times that a thread has reached the gate.
  int reached() {
    server::common::MutexLock lock(mutex_);
    return reached_;
  }

 private:
  server::common::Mutex mutex_;
  server::common::CondVar changed_;
  int reached_ DUET_GUARDED_BY(mutex_) = 0;
  bool open_ DUET_GUARDED_BY(mutex_) = false;
};

// A model whose evaluations wait until the test opens the gate.
class GatedModel {
 public:
  GatedModel() : model_(std::make_shared<FakeSynthesizer>()) {
    model_->on_batch = [this](absl::Span<const engine::SynthesisWindow* const>) { gate_.Pass(); };
  }
  std::shared_ptr<const engine::Synthesizer> get() const { return model_; }
  void WaitUntilStarted(int count) { gate_.WaitUntilReached(count); }
  void Open() { gate_.Open(); }
  // Number of evaluations that have begun.
  int started() { return gate_.reached(); }

 private:
  std::shared_ptr<FakeSynthesizer> model_;
  Gate gate_;
};

// Records every finished call.
class RecordingObserver final : public server::metrics::CallObserver {
 public:
  void CallStarted(const server::metrics::MethodInfo&) override {}
  void CallFinished(const server::metrics::CallRecord& record) override {
    server::common::MutexLock lock(mutex_);
    records_.push_back(record);
    changed_.NotifyAll();
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
  std::vector<server::metrics::CallRecord> records_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_FAKES_H_
