#include "server/service/admission.h"

#include <optional>
#include <utility>

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

Admission::Admission(const AdmissionLimits& limits)
    : places_(limits.max_calls, limits.client_share),
      bytes_(limits.max_held_bytes, limits.client_share),
      slow_requests_(limits.max_slow_requests, limits.client_share) {}

void Admission::SetState(State state) {
  common::MutexLock lock(mutex_);
  state_ = state;
}

Admission::State Admission::state() const { return state_; }

absl::Status Admission::CheckServing() const { return Refusal(state()); }

absl::StatusOr<ShareLease> Admission::Admit(const std::string& client) {
  common::MutexLock lock(mutex_);
  // The place is taken under the lock of the state. After SetState(kDraining) has returned, no call
  // is admitted, and calls() counts every admitted call.
  const absl::Status serving = Refusal(state_.load());
  if (!serving.ok()) return serving;
  std::optional<ShareLease> place = places_.Take(client);
  if (!place) return TooManyCallsRefusal(places_.taken(), places_.amount());
  return *std::move(place);
}

absl::Status Admission::CheckShare(batching::Priority priority) const {
  const std::size_t limit = batching::ShareOf(places_.amount(), priority);
  const std::size_t calls = places_.taken();
  return calls > limit ? TooManyCallsRefusal(calls - 1, limit) : absl::OkStatus();
}

absl::StatusOr<ShareLease> Admission::Hold(const std::string& client, std::size_t bytes) {
  std::optional<ShareLease> held = bytes_.Take(client, bytes);
  if (!held) return TooManyBytesRefusal(bytes, bytes_.taken(), bytes_.amount());
  return *std::move(held);
}

absl::StatusOr<ShareLease> Admission::ArriveSlowly(const std::string& client) {
  std::optional<ShareLease> leave = slow_requests_.Take(client);
  if (!leave) return TooManySlowRequestsRefusal(slow_requests_.amount());
  return *std::move(leave);
}

TransportQuota::TransportQuota(std::size_t bytes) : bytes_(bytes), quota_("duet") {
  quota_.Resize(bytes);
}

void TransportQuota::Add(std::ptrdiff_t bytes) {
  common::MutexLock lock(mutex_);
  received_ += bytes;
  quota_.Resize(bytes_ + static_cast<std::size_t>(received_));
}

}  // namespace duet::server::service
