#include "tests/server/support/puppet_scheduler.h"

#include <utility>
#include <vector>

namespace duet::test {

absl::Status PuppetScheduler::Submit(server::batching::WindowJob job) {
  server::common::MutexLock lock(mutex_);
  const bool taken = takes_continuing_ && job.continues_call;
  if (refusal_.has_value() && !taken) return *refusal_;
  jobs_.push_back(std::move(job));
  came_.NotifyAll();
  return absl::OkStatus();
}

absl::Status PuppetScheduler::CheckRoom(server::batching::Priority, const std::string&) const {
  server::common::MutexLock lock(mutex_);
  return refusal_.value_or(absl::OkStatus());
}

void PuppetScheduler::Refuse(absl::Status status, bool only_first_windows) {
  server::common::MutexLock lock(mutex_);
  refusal_ = std::move(status);
  takes_continuing_ = only_first_windows;
}

bool PuppetScheduler::RunNext() {
  const server::batching::WindowJob job = Take();
  if (job.cancelled->load()) {
    job.done({absl::CancelledError("cancelled"), {}});
    return false;
  }
  const engine::SynthesisWindow* windows[] = {&job.window};
  std::vector<engine::WindowResult> results = job.model->Synthesize(windows);
  job.done({std::move(results.front()), {0.25, 0.5, 1}});
  return true;
}

void PuppetScheduler::FailNext(absl::Status status) { Take().done({std::move(status), {}}); }

void PuppetScheduler::WaitForJobs(std::size_t count) {
  server::common::MutexLock lock(mutex_);
  while (jobs_.size() < count) came_.Wait(mutex_);
}

std::size_t PuppetScheduler::queued_windows() const {
  server::common::MutexLock lock(mutex_);
  return jobs_.size();
}

server::batching::WindowJob PuppetScheduler::Oldest() const {
  server::common::MutexLock lock(mutex_);
  return jobs_.front();
}

server::batching::WindowJob PuppetScheduler::Take() {
  server::common::MutexLock lock(mutex_);
  while (jobs_.empty()) came_.Wait(mutex_);
  server::batching::WindowJob job = std::move(jobs_.front());
  jobs_.pop_front();
  return job;
}

}  // namespace duet::test
