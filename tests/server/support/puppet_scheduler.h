#ifndef DUET_TESTS_SERVER_SUPPORT_PUPPET_SCHEDULER_H_
#define DUET_TESTS_SERVER_SUPPORT_PUPPET_SCHEDULER_H_

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "server/batching/window_scheduler.h"
#include "server/common/mutex.h"

namespace duet::test {

// A WindowScheduler with which a test decides when each window is evaluated, on the test's thread.
//
// Threads: safe to call concurrently.
class PuppetScheduler final : public server::batching::WindowScheduler {
 public:
  absl::Status Submit(server::batching::WindowJob job) override;

  absl::Status CheckRoom(server::batching::Priority priority,
                         const std::string& client) const override;

  // Makes Submit and CheckRoom fail with this status. With `only_first_windows`, as a full queue:
  // Submit takes the later windows of a call.
  void Refuse(absl::Status status, bool only_first_windows = false);

  // Waits for a job and evaluates the oldest, or drops it if cancelled. Returns whether it was
  // evaluated.
  bool RunNext();
  // Waits for a job and ends the oldest with an error.
  void FailNext(absl::Status status);
  // Waits until there are that many jobs. A test that waits in vain reaches its timeout.
  void WaitForJobs(std::size_t count);

  std::size_t queued_windows() const override;
  // A copy of the oldest job. There must be one.
  server::batching::WindowJob Oldest() const;

 private:
  server::batching::WindowJob Take();

  mutable server::common::Mutex mutex_;
  server::common::CondVar came_;
  std::deque<server::batching::WindowJob> jobs_ DUET_GUARDED_BY(mutex_);
  std::optional<absl::Status> refusal_ DUET_GUARDED_BY(mutex_);
  bool takes_continuing_ DUET_GUARDED_BY(mutex_) = false;  // in spite of refusal_
};

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_PUPPET_SCHEDULER_H_
