#ifndef DUET_TESTS_SERVER_SUPPORT_GATED_MODEL_H_
#define DUET_TESTS_SERVER_SUPPORT_GATED_MODEL_H_

#include <memory>

#include "server/common/mutex.h"
#include "tests/support/fake_synthesizer.h"

namespace duet::test {

// A model whose evaluations wait until the test opens the gate.
//
// Threads: safe to call concurrently.
class GatedModel {
 public:
  GatedModel() : model_(std::make_shared<FakeSynthesizer>()) {
    model_->on_batch = [this](absl::Span<const engine::SynthesisWindow* const>) { Pass(); };
  }
  std::shared_ptr<const engine::Synthesizer> get() const { return model_; }

  void WaitUntilStarted(int count) {
    server::common::MutexLock lock(mutex_);
    while (started_ < count) changed_.Wait(mutex_);
  }
  void Open() {
    server::common::MutexLock lock(mutex_);
    open_ = true;
    changed_.NotifyAll();
  }
  // Number of evaluations that have begun.
  int started() {
    server::common::MutexLock lock(mutex_);
    return started_;
  }

 private:
  void Pass() {
    server::common::MutexLock lock(mutex_);
    ++started_;
    changed_.NotifyAll();
    while (!open_) changed_.Wait(mutex_);
  }

  std::shared_ptr<FakeSynthesizer> model_;
  server::common::Mutex mutex_;
  server::common::CondVar changed_;
  int started_ DUET_GUARDED_BY(mutex_) = 0;
  bool open_ DUET_GUARDED_BY(mutex_) = false;
};

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_GATED_MODEL_H_
