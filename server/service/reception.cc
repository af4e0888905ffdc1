#include "server/service/reception.h"

#include <utility>

#include "server/service/refusals.h"

namespace duet::server::service {

Reception::Reception(Parts parts) : parts_(std::move(parts)), begin_(parts_.clock->Now()) {}

bool Reception::Received() {
  ShareLease slow;  // another message may arrive slowly while this one waits to be handled
  common::MutexLock lock(mutex_);
  if (state_ != State::kReceiving) return false;
  state_ = State::kHandling;
  slow = std::move(slow_);
  return true;
}

void Reception::Lost(bool cancelled) {
  EndFrom(State::kReceiving,
          cancelled ? absl::CancelledError("the caller disconnected before its request arrived")
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
  // Everything is free before the call is reported, as in StreamingCall::Finish.
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

void Reception::GoOn(std::shared_ptr<StreamingCall> call, std::shared_ptr<MessageSink> further) {
  // Start first, so that Abort and CheckTime find a call that has started.
  call->Start();
  std::optional<absl::Status> end;
  std::shared_ptr<MessageSink> draining;
  {
    common::MutexLock lock(mutex_);
    call_ = call;
    end = end_;
    // The call may have ended within Start.
    if (state_ == State::kHandling) {
      state_ = State::kAnswering;
      further_ = std::move(further);
      if (draining_) draining = further_;
    }
  }
  if (draining != nullptr) draining->OnDraining();
  if (end) call->Abort(*end);
}

bool Reception::ReadNext(double timeout_seconds) {
  common::MutexLock lock(mutex_);
  if (state_ != State::kAnswering || further_ == nullptr || reading_.has_value()) return false;
  reading_ = {parts_.clock->Now(), timeout_seconds};
  // Under the lock, so that Close cannot let the reader be destroyed in between.
  parts_.reader->Read();
  return true;
}

std::shared_ptr<MessageSink> Reception::FinishReading() {
  common::MutexLock lock(mutex_);
  reading_.reset();
  return state_ == State::kAnswering ? further_ : nullptr;
}

void Reception::HandOn(grpc::ByteBuffer bytes) {
  const std::shared_ptr<MessageSink> sink = FinishReading();
  if (sink != nullptr) sink->OnMessage(std::move(bytes));
}

void Reception::EndOfMessages() {
  const std::shared_ptr<MessageSink> sink = FinishReading();
  if (sink == nullptr) return;
  {
    common::MutexLock lock(mutex_);
    further_.reset();
  }
  sink->OnEndOfMessages();
}

void Reception::Close() {
  std::shared_ptr<MessageSink> further;  // destroyed under no lock
  common::MutexLock lock(mutex_);
  state_ = State::kEnded;
  further = std::move(further_);
}

void Reception::Drain() {
  std::shared_ptr<MessageSink> sink;
  {
    common::MutexLock lock(mutex_);
    if (std::exchange(draining_, true)) return;
    sink = further_;
  }
  if (sink != nullptr) sink->OnDraining();
}

void Reception::Abort(const absl::Status& reason) {
  if (EndFrom(State::kReceiving, reason)) return;
  std::shared_ptr<StreamingCall> call;
  {
    common::MutexLock lock(mutex_);
    if (state_ == State::kHandling && !end_) end_ = reason;
    call = call_;
  }
  if (call != nullptr) call->Abort(reason);
}

void Reception::CheckTime(common::TimePoint now) {
  std::shared_ptr<StreamingCall> call;
  absl::Status arrival, next;
  {
    common::MutexLock lock(mutex_);
    if (state_ == State::kReceiving) arrival = CheckArrival(common::SecondsBetween(begin_, now));
    if (reading_ && common::SecondsBetween(reading_->begin, now) >= reading_->timeout_seconds) {
      next = LiveIdleRefusal(reading_->timeout_seconds);
    }
    call = call_;
  }
  if (!arrival.ok()) EndFrom(State::kReceiving, arrival);
  if (call == nullptr) return;
  if (!next.ok()) call->Abort(next);
  call->CheckTime(now);
}

std::shared_ptr<StreamingCall> Reception::call() const {
  common::MutexLock lock(mutex_);
  return call_;
}

std::optional<common::TimePoint> Reception::waiting_since() const {
  const std::shared_ptr<StreamingCall> answering = call();
  return answering == nullptr ? std::nullopt : answering->waiting_since();
}

std::optional<std::size_t> Reception::GiveUpReader(common::TimePoint now, double seconds) {
  const std::shared_ptr<StreamingCall> answering = call();
  return answering == nullptr ? std::nullopt : answering->GiveUpReader(now, seconds);
}

std::optional<common::TimePoint> Reception::idle_since() const {
  std::optional<common::TimePoint> since;
  std::shared_ptr<StreamingCall> call;
  std::shared_ptr<MessageSink> sink;
  {
    common::MutexLock lock(mutex_);
    if (state_ != State::kAnswering || !reading_.has_value() || given_up_) return std::nullopt;
    since = reading_->begin;
    call = call_;
    sink = further_;
  }
  const bool owes = sink == nullptr || sink->OwesAnswers() || call->waiting_since().has_value();
  return owes ? std::nullopt : since;
}

bool Reception::GiveUpIdle(common::TimePoint now, double seconds) {
  const std::optional<common::TimePoint> since = idle_since();
  if (!since.has_value() || common::SecondsBetween(*since, now) < seconds) return false;
  {
    common::MutexLock lock(mutex_);
    if (std::exchange(given_up_, true)) return false;
  }
  call()->Abort(DisplacedSessionRefusal(seconds));
  return true;
}

absl::Status Reception::CheckArrival(double waited) {
  if (waited >= parts_.limits.timeout_seconds) {
    return ReceiveTimeoutRefusal(parts_.limits.timeout_seconds);
  }
  if (waited < parts_.limits.slow_seconds || slow_) return absl::OkStatus();
  absl::StatusOr<ShareLease> leave = parts_.admission->ArriveSlowly(parts_.client);
  if (leave.ok()) slow_ = *std::move(leave);
  return leave.status();
}

}  // namespace duet::server::service
