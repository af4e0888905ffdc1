#include "server/service/call.h"

#include <grpc/grpc.h>
#include <grpcpp/impl/codegen/server_callback_handlers.h>
#include <grpcpp/impl/rpc_method.h>
#include <grpcpp/impl/rpc_service_method.h>

#include <algorithm>
#include <chrono>

#include "server/common/error_details.h"
#include "server/service/refusals.h"
#include "server/service/wire.h"

namespace duet::server::service {

bool Call::OnFirstMessage() {
  ShareLease slow;  // another message may arrive slowly while this one waits to be handled
  common::MutexLock lock(mutex_);
  if (state_ != State::kReceiving) return false;
  state_ = State::kHandling;
  slow = std::move(slow_);
  return true;
}

void Call::OnNoMessage(bool cancelled) {
  EndFrom(State::kReceiving,
          cancelled ? absl::CancelledError("the caller disconnected before its request arrived")
                    : NoMessageRefusal());
}

std::optional<absl::Status> Call::ended_meanwhile() const {
  common::MutexLock lock(mutex_);
  return end_;
}

void Call::Refuse(const absl::Status& reason) { EndFrom(State::kHandling, reason); }

void Call::Run(Stream stream) {
  stream_ = std::move(stream);
  // Weak: work in progress may outlive a finished call, and must not keep it.
  const std::weak_ptr<Call> weak = weak_from_this();
  SourceEvents events;
  events.on_progress = [weak] {
    if (const auto alive = weak.lock()) alive->Advance();
  };
  events.read_next = [weak](double timeout_seconds) {
    const auto alive = weak.lock();
    return alive != nullptr && alive->ReadNext(timeout_seconds);
  };
  const absl::Status started = stream_.source->Start(std::move(events));
  bool draining = false, ended = false;
  {
    common::MutexLock lock(mutex_);
    if (!started.ok()) SetEnd(started);
    ended = end_.has_value();
    draining = draining_ && stream_.takes_messages;
    state_ = State::kIdle;
  }
  if (draining) stream_.source->OnDraining();
  if (ended) stream_.source->Cancel();
  Advance();
}

bool Call::ReadNext(double timeout_seconds) {
  common::MutexLock lock(mutex_);
  if (state_ == State::kFinished || !stream_.takes_messages || reading_.has_value()) return false;
  reading_ = {parts_.clock->Now(), timeout_seconds};
  // Under the lock, so that Finish cannot let the transport be destroyed in between.
  parts_.transport->Read();
  return true;
}

bool Call::FinishReading() {
  reading_.reset();
  return state_ != State::kFinished && stream_.takes_messages;
}

void Call::OnMessage(grpc::ByteBuffer bytes) {
  {
    common::MutexLock lock(mutex_);
    if (!FinishReading()) return;
  }
  stream_.source->OnMessage(ParseLiveMessage(std::move(bytes)));
}

void Call::OnEndOfMessages() {
  {
    common::MutexLock lock(mutex_);
    if (!FinishReading()) return;
    stream_.takes_messages = false;
  }
  stream_.source->OnEndOfMessages();
}

void Call::OnWritten(bool ok) {
  {
    common::MutexLock lock(mutex_);
    state_ = State::kIdle;
    if (!ok) SetEnd(absl::CancelledError("the caller disconnected"));
  }
  if (!ok) stream_.source->Cancel();
  Advance();
}

void Call::Advance() {
  // Finish may drop the last other reference.
  const std::shared_ptr<Call> self = shared_from_this();
  while (true) {
    std::optional<absl::Status> end;
    {
      common::MutexLock lock(mutex_);
      again_ = true;
      if (state_ != State::kIdle || breaking_off_) return;
      end = end_;
      state_ = end.has_value() ? State::kFinished : State::kAsking;
      again_ = false;
    }
    if (end.has_value()) return Finish(*end);
    metrics::CallRecord& record = parts_.scope->record();
    const NextReply next = stream_.source->Next(record);
    if (record.chunks > 0 && record.first_chunk_seconds < 0) {
      record.first_chunk_seconds = parts_.scope->ElapsedSeconds();
    }
    bool writes = false;
    {
      common::MutexLock lock(mutex_);
      if (next.end.has_value()) SetEnd(*next.end);
      writes = next.message != nullptr && !end_.has_value();
      state_ = writes ? State::kWriting : State::kIdle;
      if (writes) write_began_ = parts_.clock->Now();
      if (!writes && !end_.has_value() && !again_) return;
    }
    if (writes) return parts_.transport->Write(*next.message);
  }
}

void Call::Drain() {
  {
    common::MutexLock lock(mutex_);
    if (std::exchange(draining_, true) || !is_streaming() || !stream_.takes_messages) return;
  }
  stream_.source->OnDraining();
}

void Call::Abort(const absl::Status& reason) {
  if (EndFrom(State::kReceiving, reason)) return;
  {
    common::MutexLock lock(mutex_);
    SetEnd(reason);
    if (!is_streaming()) return;
  }
  stream_.source->Cancel();
  Advance();
}

void Call::CheckTime(common::TimePoint now) {
  absl::Status late_arrival;
  std::optional<absl::Status> end;
  bool break_off = false;
  {
    common::MutexLock lock(mutex_);
    if (state_ == State::kReceiving) late_arrival = CheckArrival(now);
    if (is_streaming() && !breaking_off_) {
      break_off = breaking_off_ = EndLate(now);
      end = end_;
    }
  }
  if (!late_arrival.ok()) EndFrom(State::kReceiving, late_arrival);
  if (break_off) return BreakOff(*end);
  if (!end.has_value()) return;
  stream_.source->Cancel();
  Advance();
}

absl::Status Call::CheckArrival(common::TimePoint now) {
  const double waited = common::SecondsBetween(begin_, now);
  if (waited >= parts_.limits.timeout_seconds) {
    return ReceiveTimeoutRefusal(parts_.limits.timeout_seconds);
  }
  if (waited < parts_.limits.slow_seconds || slow_) return absl::OkStatus();
  absl::StatusOr<ShareLease> leave = parts_.admission->ArriveSlowly(parts_.client);
  if (leave.ok()) slow_ = *std::move(leave);
  return leave.status();
}

bool Call::EndLate(common::TimePoint now) {
  if (reading_ && common::SecondsBetween(reading_->begin, now) >= reading_->timeout_seconds) {
    SetEnd(LiveIdleRefusal(reading_->timeout_seconds));
  }
  if (now >= stream_.deadline) {
    SetEnd(absl::DeadlineExceededError(
        "the call's deadline passed, or it took longer than the server answers any call"));
  }
  const bool stalled = state_ == State::kWriting &&
                       common::SecondsBetween(write_began_, now) >= stream_.write_timeout_seconds;
  if (stalled) SetEnd(WriteTimeoutRefusal(stream_.write_timeout_seconds));
  return stalled;
}

void Call::BreakOffWrite() {
  absl::Status reason;
  {
    common::MutexLock lock(mutex_);
    if (state_ != State::kWriting || breaking_off_ || !end_.has_value()) return;
    breaking_off_ = true;
    reason = *end_;
  }
  BreakOff(reason);
}

void Call::BreakOff(const absl::Status& reason) {
  stream_.source->Cancel();
  parts_.transport->BreakOff(reason);
  {
    common::MutexLock lock(mutex_);
    breaking_off_ = false;
  }
  Advance();
}

void Call::SetEnd(const absl::Status& reason) {
  if (!end_.has_value()) end_ = reason;
}

bool Call::EndFrom(State state, const absl::Status& reason) {
  {
    common::MutexLock lock(mutex_);
    if (state_ != state) return false;
    state_ = State::kFinished;
  }
  Finish(reason);
  return true;
}

void Call::Finish(const absl::Status& status) {
  ShareLease place, held_bytes, slow;
  {
    common::MutexLock lock(mutex_);
    place = std::move(parts_.place);
    held_bytes = std::move(stream_.held_bytes);
    slow = std::move(slow_);
  }
  const std::unique_ptr<CallScope> scope = std::move(parts_.scope);
  if (stream_.source != nullptr) stream_.source->Report(scope->record());
  // All shares are free before the call is reported, and the call is reported before its caller
  // gets the status, so none of them is seen without the one before. Under no lock, because
  // observers may be slow.
  place = ShareLease();
  held_bytes = ShareLease();
  slow = ShareLease();
  parts_.transport->Finish(*scope, status);
}

void ActiveCalls::Add(const std::shared_ptr<Call>& call) {
  std::optional<absl::Status> ended;
  bool draining = false;
  {
    common::MutexLock lock(mutex_);
    calls_.push_back(call);
    ended = ended_;
    draining = draining_;
  }
  if (draining) call->Drain();
  if (ended) call->Abort(*ended);
}

void ActiveCalls::Drain() {
  {
    // A call that was admitted before the drain began may be added after this.
    common::MutexLock lock(mutex_);
    draining_ = true;
  }
  for (const std::shared_ptr<Call>& call : All()) call->Drain();
}

void ActiveCalls::AbortAll(const absl::Status& reason) {
  {
    // A call that was admitted before the server stopped admitting calls may be added after this.
    common::MutexLock lock(mutex_);
    ended_ = reason;
  }
  for (const std::shared_ptr<Call>& call : All()) call->Abort(reason);
}

void ActiveCalls::CheckTime(common::TimePoint now) {
  for (const std::shared_ptr<Call>& call : All()) call->CheckTime(now);
}

void ActiveCalls::FinishAborted(double seconds) {
  {
    const auto end = std::chrono::steady_clock::now() +
                     std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                         std::chrono::duration<double>(seconds));
    common::MutexLock lock(mutex_);
    while (open_ > 0 && changed_.WaitUntil(mutex_, end)) {
    }
  }
  for (const std::shared_ptr<Call>& call : All()) call->BreakOffWrite();
}

std::vector<std::shared_ptr<Call>> ActiveCalls::All() {
  std::vector<std::shared_ptr<Call>> alive;
  common::MutexLock lock(mutex_);
  const auto is_dead = [](const std::weak_ptr<Call>& call) { return call.expired(); };
  calls_.erase(std::remove_if(calls_.begin(), calls_.end(), is_dead), calls_.end());
  alive.reserve(calls_.size());
  for (const std::weak_ptr<Call>& weak : calls_) {
    if (std::shared_ptr<Call> call = weak.lock()) alive.push_back(std::move(call));
  }
  return alive;
}

void ActiveCalls::CountOpen(int calls) {
  common::MutexLock lock(mutex_);
  open_ += calls;
  if (open_ == 0) changed_.NotifyAll();
}

namespace {

// When its deadline passes, a client resets the call. The reset can arrive before the deadline
// passes here, because the call began here later by the time that the request travelled.
constexpr double kDeadlineSlackSeconds = 0.1;

}  // namespace

// Does what the constructors of generated services do. gRPC itself serves unary methods as streams
// this way (grpc::Service::MarkMethodStreamed).
void RawService::Serve(const char* method,
                       std::function<Reactor*(grpc::CallbackServerContext*)> open) {
  using grpc::internal::CallbackBidiHandler;
  using grpc::internal::RpcMethod;
  using grpc::internal::RpcServiceMethod;
  AddMethod(new RpcServiceMethod(method, RpcMethod::BIDI_STREAMING, nullptr));
  MarkMethodRawCallback(methods_++,
                        new CallbackBidiHandler<grpc::ByteBuffer, grpc::ByteBuffer>(
                            [open = std::move(open)](grpc::CallbackServerContext* context) {
                              return open(context);
                            }));
}

void CallReactor::Receive(std::shared_ptr<Call> call, Handler handle) {
  call_ = std::move(call);
  handle_ = std::move(handle);
  StartRead(&request_);
}

void CallReactor::OnReadDone(bool ok) {
  // Copied, because the call may end while its message is handled.
  const std::shared_ptr<Call> call = call_;
  grpc::ByteBuffer bytes;
  bytes.Swap(&request_);
  if (handle_ == nullptr) {
    if (ok) {
      call->OnMessage(std::move(bytes));
    } else if (!context_.IsCancelled()) {  // OnCancel ends a cancelled call
      call->OnEndOfMessages();
    }
    return;
  }
  const Handler handle = std::exchange(handle_, nullptr);
  if (!ok) {
    call->OnNoMessage(context_.IsCancelled());
  } else if (call->OnFirstMessage()) {
    handle(call, std::move(bytes));
  }
}

void CallReactor::Write(const google::protobuf::Message& reply) {
  reply_ = SerializeMessage(reply);
  StartWrite(&reply_);
}

void CallReactor::Finish(CallScope& scope, const absl::Status& status) {
  CallPipeline::Report(scope, status, context_);
  ServerBidiReactor::Finish(common::ToGrpcStatus(status));
}

// Does what ServerContext::TryCancel does, with another status than CANCELLED. The status overtakes
// messages that wait for the reader.
void CallReactor::BreakOff(const absl::Status& reason) {
  const grpc::Status status = common::ToGrpcStatus(reason);
  grpc_call_cancel_with_status(context_.c_call(),
                               static_cast<grpc_status_code>(status.error_code()),
                               status.error_message().c_str(), nullptr);
}

void CallReactor::OnWriteDone(bool ok) { call_->OnWritten(ok); }

void CallReactor::OnCancel() {
  if (call_ == nullptr) return;
  const bool expired = SecondsLeft(context_) <= kDeadlineSlackSeconds;
  call_->Abort(expired ? absl::DeadlineExceededError("the call's deadline passed")
                       : absl::CancelledError("the caller cancelled"));
}

}  // namespace duet::server::service
