#include "server/service/admission.h"

#include "server/service/refusals.h"

namespace duet::server::service {
namespace {

absl::Status Refusal(Admission::State state) {
  switch (state) {
    case Admission::State::kLoading:
      return LoadingRefusal();
    case Admission::State::kDraining:
      return DrainingRefusal();
    case Admission::State::kServing:
      break;
  }
  return absl::OkStatus();
}

}  // namespace

AdmissionSlot::~AdmissionSlot() {
  if (admission_ != nullptr) admission_->Leave();
}

void Admission::SetState(State state) {
  common::MutexLock lock(mutex_);
  state_ = state;
}

Admission::State Admission::state() const {
  common::MutexLock lock(mutex_);
  return state_;
}

absl::Status Admission::CheckServing() const { return Refusal(state()); }

absl::StatusOr<AdmissionSlot> Admission::Admit(batching::Priority priority) {
  const std::size_t limit = batching::ShareOf(max_calls_, priority);
  common::MutexLock lock(mutex_);
  // The state is read under the lock that guards the count: once SetState(kDraining) has returned,
  // no further call is admitted, and calls() counts every call that was.
  const absl::Status serving = Refusal(state_);
  if (!serving.ok()) return serving;
  if (calls_ >= limit) return TooManyCallsRefusal(calls_, limit);
  ++calls_;
  return AdmissionSlot(this);
}

std::size_t Admission::calls() const {
  common::MutexLock lock(mutex_);
  return calls_;
}

void Admission::Leave() {
  common::MutexLock lock(mutex_);
  --calls_;
}

}  // namespace duet::server::service
