#include "server/service/streaming_call.h"

#include <utility>

#include "server/service/refusals.h"

namespace duet::server::service {

std::shared_ptr<StreamingCall> StreamingCall::Create(Parts parts,
                                                     std::unique_ptr<ReplySource> source,
                                                     ReplyWriter& writer) {
  return std::shared_ptr<StreamingCall>(
      new StreamingCall(std::move(parts), std::move(source), writer));
}

StreamingCall::StreamingCall(Parts parts, std::unique_ptr<ReplySource> source, ReplyWriter& writer)
    : deadline_(parts.deadline),
      write_timeout_seconds_(parts.write_timeout_seconds),
      clock_(*parts.clock),
      writer_(writer),
      source_(std::move(source)),
      place_(std::move(parts.place)),
      held_bytes_(std::move(parts.held_bytes)),
      scope_(std::move(parts.scope)) {}

void StreamingCall::Start() {
  // Weak: work in progress may outlive a finished call, and must not keep it.
  const absl::Status started = source_->Start([weak = weak_from_this()] {
    if (const auto alive = weak.lock()) alive->Advance();
  });
  if (!started.ok()) Abort(started);
  Advance();
}

void StreamingCall::OnWritten(bool ok) {
  {
    common::MutexLock lock(mutex_);
    state_ = State::kIdle;
    if (!ok && !end_.has_value()) end_ = absl::CancelledError("the caller disconnected");
    if (!ok) source_->Cancel();
  }
  Advance();
}

void StreamingCall::Abort(const absl::Status& reason) {
  {
    common::MutexLock lock(mutex_);
    if (!end_.has_value()) end_ = reason;
  }
  source_->Cancel();
  Advance();
}

void StreamingCall::CheckTime(common::TimePoint now) {
  std::optional<absl::Status> break_off;
  {
    common::MutexLock lock(mutex_);
    if (state_ == State::kFinished || breaking_off_) return;
    breaking_off_ = EndLate(now);
    if (!end_.has_value()) return;
    if (breaking_off_) break_off = end_;
  }
  if (break_off.has_value()) return BreakOff(*break_off);
  source_->Cancel();
  Advance();
}

std::optional<common::TimePoint> StreamingCall::waiting_since() const {
  common::MutexLock lock(mutex_);
  if (state_ != State::kWriting || given_up_) return std::nullopt;
  return write_began_;
}

std::optional<std::size_t> StreamingCall::GiveUpReader(common::TimePoint now, double seconds) {
  ShareLease place;
  absl::Status reason;
  std::size_t bytes = 0;
  {
    common::MutexLock lock(mutex_);
    if (state_ != State::kWriting || breaking_off_ || given_up_) return std::nullopt;
    if (common::SecondsBetween(write_began_, now) < seconds) return std::nullopt;
    if (!end_.has_value()) end_ = StalledReaderRefusal(seconds);
    reason = *end_;
    breaking_off_ = true;
    given_up_ = true;
    // Another call waits for the place. The bytes are held until the call releases them.
    place = std::move(place_);
    bytes = held_bytes_.amount();
  }
  BreakOff(reason);
  return bytes;
}

void StreamingCall::BreakOff(const absl::Status& reason) {
  source_->Cancel();
  writer_.BreakOff(reason);
  {
    common::MutexLock lock(mutex_);
    breaking_off_ = false;
  }
  Advance();
}

bool StreamingCall::EndLate(common::TimePoint now) {
  if (now >= deadline_ && !end_.has_value()) {
    end_ = absl::DeadlineExceededError(
        "the call's deadline passed, or it took longer than the server answers any call");
  }
  const bool stalled = state_ == State::kWriting &&
                       common::SecondsBetween(write_began_, now) >= write_timeout_seconds_;
  if (stalled && !end_.has_value()) end_ = WriteTimeoutRefusal(write_timeout_seconds_);
  return stalled;
}

void StreamingCall::Advance() {
  // The writer's Finish may drop the last other reference.
  const std::shared_ptr<StreamingCall> self = shared_from_this();
  NextReply next;
  {
    common::MutexLock lock(mutex_);
    if (state_ != State::kIdle || breaking_off_) return;
    if (!end_.has_value()) {
      next = source_->Next(*scope_);
      end_ = next.end;
    }
    if (end_.has_value()) {
      next = {nullptr, end_};
      state_ = State::kFinished;
    } else if (next.message != nullptr) {
      state_ = State::kWriting;
      write_began_ = clock_.Now();
    }
  }
  if (next.end.has_value()) {
    Finish(*next.end);
  } else if (next.message != nullptr) {
    writer_.Write(*next.message);
  }
}

void StreamingCall::Finish(const absl::Status& status) {
  ShareLease place, held_bytes;
  std::unique_ptr<CallScope> scope;
  {
    common::MutexLock lock(mutex_);
    place = std::move(place_);
    held_bytes = std::move(held_bytes_);
    scope = std::move(scope_);
  }
  source_->Report(scope->record());
  // The place is free before the call is reported, and the call is reported before its caller gets
  // the status, so none of them is seen without the one before. Under no lock, because observers
  // may be slow.
  place = ShareLease();
  held_bytes = ShareLease();
  writer_.Finish(*scope, status);
}

}  // namespace duet::server::service
