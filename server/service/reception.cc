#include "server/service/reception.h"

#include <utility>

#include "server/service/refusals.h"

namespace duet::server::service {

Reception::Reception(Parts parts) : parts_(std::move(parts)), begin_(parts_.clock->Now()) {}

bool Reception::Received() {
  ShareLease slow;  // others may arrive slowly while this one waits to be handled
  common::MutexLock lock(mutex_);
  if (state_ != State::kReceiving) return false;
  state_ = State::kHandling;
  slow = std::move(slow_);
  return true;
}

void Reception::Lost(bool cancelled) {
  EndFrom(State::kReceiving,
          cancelled ? absl::CancelledError("the caller went away before its request had come")
                    : NoMessageRefusal());
}

std::optional<absl::Status> Reception::ended_meanwhile() const {
  common::MutexLock lock(mutex_);
  return end_;
}

void Reception::Refuse(const absl::Status& reason) { EndFrom(State::kHandling, reason); }

bool Reception::EndFrom(State state, const absl::Status& reason) {
  ShareLease slow;
  {
    common::MutexLock lock(mutex_);
    if (state_ != state) return false;
    state_ = State::kEnded;
    slow = std::move(slow_);
  }
  // Everything is free before the call is reported, as in SynthesisCall::Finish.
  slow = ShareLease();
  parts_.place = ShareLease();
  const std::unique_ptr<CallScope> scope = std::move(parts_.scope);
  parts_.writer->Finish(*scope, reason);
  return true;
}

std::unique_ptr<CallScope> Reception::Answer() {
  common::MutexLock lock(mutex_);
  state_ = State::kEnded;
  return std::move(parts_.scope);
}

std::unique_ptr<CallScope> Reception::TakeScope() { return std::move(parts_.scope); }

ShareLease Reception::TakePlace() { return std::move(parts_.place); }

void Reception::GoOn(std::shared_ptr<SynthesisCall> call) {
  // First, so that what ends the call finds one that has begun.
  call->Start();
  std::optional<absl::Status> end;
  {
    common::MutexLock lock(mutex_);
    state_ = State::kAnswering;
    call_ = call;
    end = end_;
  }
  if (end) call->Abort(*end);
}

void Reception::Abort(const absl::Status& reason) {
  if (EndFrom(State::kReceiving, reason)) return;
  std::shared_ptr<SynthesisCall> call;
  {
    common::MutexLock lock(mutex_);
    if (state_ == State::kHandling && !end_) end_ = reason;
    call = call_;
  }
  if (call != nullptr) call->Abort(reason);
}

void Reception::CheckTime(common::TimePoint now) {
  std::shared_ptr<SynthesisCall> call;
  absl::Status in_time;
  {
    common::MutexLock lock(mutex_);
    if (state_ == State::kReceiving) in_time = LeaveToArrive(common::SecondsBetween(begin_, now));
    call = call_;
  }
  if (!in_time.ok()) EndFrom(State::kReceiving, in_time);
  if (call != nullptr) call->CheckTime(now);
}

std::shared_ptr<SynthesisCall> Reception::call() const {
  common::MutexLock lock(mutex_);
  return call_;
}

std::optional<common::TimePoint> Reception::waiting_since() const {
  const std::shared_ptr<SynthesisCall> answering = call();
  return answering == nullptr ? std::nullopt : answering->waiting_since();
}

std::optional<std::size_t> Reception::GiveUpReader(common::TimePoint now, double seconds) {
  const std::shared_ptr<SynthesisCall> answering = call();
  return answering == nullptr ? std::nullopt : answering->GiveUpReader(now, seconds);
}

absl::Status Reception::LeaveToArrive(double waited) {
  if (waited >= parts_.limits.timeout_seconds) {
    return ReceiveTimeoutRefusal(parts_.limits.timeout_seconds);
  }
  if (waited < parts_.limits.slow_seconds || slow_) return absl::OkStatus();
  absl::StatusOr<ShareLease> leave = parts_.admission->ArriveSlowly(parts_.client);
  if (leave.ok()) slow_ = *std::move(leave);
  return leave.status();
}

}  // namespace duet::server::service
