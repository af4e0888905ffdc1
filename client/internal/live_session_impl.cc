#include "client/internal/live_session_impl.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/internal/grpc_status.h"
#include "client/internal/proto_conversion.h"

namespace duet::client::internal {
namespace {

// Waits between attempts to resume: a leader moves on meanwhile.
constexpr absl::Duration kFirstResumeWait = absl::Milliseconds(20);
constexpr absl::Duration kLongestResumeWait = absl::Milliseconds(500);
// How soon a wait notices that the session was abandoned.
constexpr absl::Duration kSleepSlice = absl::Milliseconds(50);

RetryOptions ForResuming(RetryOptions options) {
  options.initial_backoff = std::min(options.initial_backoff, kFirstResumeWait);
  options.max_backoff = std::min(options.max_backoff, kLongestResumeWait);
  return options;
}

// A server that drains or loads states a delay, but the next attempt may reach another server.
absl::Status WithoutDelay(absl::Status status) {
  if (absl::IsUnavailable(status)) status.ErasePayload("type.googleapis.com/google.rpc.RetryInfo");
  return status;
}

}  // namespace

absl::StatusOr<std::unique_ptr<LiveSession>> LiveSessionImpl::Start(
    std::shared_ptr<v1::MotionSynthesis::Stub> stub, const LiveRequest& request,
    LiveCallbacks callbacks, LiveSettings settings) {
  if (!callbacks.on_frames) {
    return absl::InvalidArgumentError("on_frames: expected a function, got none");
  }
  absl::Status accepted = CheckRequestId(request.request_id);
  if (!accepted.ok()) return accepted;
  absl::StatusOr<LiveState> state = LiveState::Create(request);
  if (!state.ok()) return state.status();
  std::unique_ptr<LiveSessionImpl> session(
      new LiveSessionImpl(std::move(stub), *std::move(state), request.request_id,
                          std::move(callbacks), std::move(settings)));
  Lock lock(session->mutex_);
  session->changed_.wait(
      lock, [&] { return session->state_.info().has_value() || session->ended_.has_value(); });
  if (!session->state_.info().has_value()) return *session->ended_;
  lock.unlock();
  return session;
}

LiveSessionImpl::LiveSessionImpl(std::shared_ptr<v1::MotionSynthesis::Stub> stub, LiveState state,
                                 std::string request_id, LiveCallbacks callbacks,
                                 LiveSettings settings)
    : stub_(std::move(stub)),
      request_id_(std::move(request_id)),
      callbacks_(std::move(callbacks)),
      settings_(std::move(settings)),
      state_(std::move(state)) {
  writer_ = std::thread([this] { Write(); });
  reader_ = std::thread([this] { Read(); });
}

LiveSessionImpl::~LiveSessionImpl() {
  {
    const Lock lock(mutex_);
    abandoned_ = true;
    if (context_ != nullptr) context_->TryCancel();
    changed_.notify_all();
  }
  reader_.join();
  writer_.join();
}

absl::Status LiveSessionImpl::CheckOpen() const {
  if (ended_.has_value() && !ended_->ok()) return *ended_;
  if (!finishing_) return absl::OkStatus();
  return absl::FailedPreconditionError("the leader's motion has ended: Finish was called");
}

void LiveSessionImpl::Enqueue(v1::SynthesizeLiveRequest message) {
  // Without a stream, the message is lost: the next stream begins with everything that it says.
  if (!can_write_) return;
  outgoing_.push_back(std::move(message));
  changed_.notify_all();
}

absl::Status LiveSessionImpl::Send(int first_frame, absl::Span<const motion::Vec3> positions,
                                   double capture_seconds) {
  const Lock lock(mutex_);
  absl::Status open = CheckOpen();
  if (!open.ok()) return open;
  CheckSilence();  // the writer cannot while the network takes nothing
  const bool was_due = state_.IsDue();
  absl::StatusOr<v1::SynthesizeLiveRequest> message =
      state_.AddFrames(first_frame, positions, capture_seconds);
  if (!message.ok()) return message.status();
  if (!was_due) heard_ = std::chrono::steady_clock::now();
  Enqueue(*std::move(message));
  return absl::OkStatus();
}

absl::Status LiveSessionImpl::ChangeLabels(const std::vector<ClassWeight>& weights,
                                           absl::Duration ease) {
  const Lock lock(mutex_);
  absl::Status open = CheckOpen();
  if (!open.ok()) return open;
  absl::StatusOr<v1::SynthesizeLiveRequest> message = state_.ChangeLabels(weights, ease);
  if (!message.ok()) return message.status();
  Enqueue(*std::move(message));
  return absl::OkStatus();
}

absl::StatusOr<LiveSummary> LiveSessionImpl::Finish() {
  Lock lock(mutex_);
  if (!finishing_) heard_ = std::chrono::steady_clock::now();
  finishing_ = true;
  changed_.notify_all();
  while (!changed_.wait_for(lock, SilenceCheckPeriod(), [this] { return ended_.has_value(); })) {
    CheckSilence();
  }
  if (!ended_->ok()) return *ended_;
  return state_.summary();
}

// ---- The reader. ----

void LiveSessionImpl::Read() {
  absl::Status status;
  bool over = false;
  while (!over && status.ok()) {
    status = RunUntilBroken();
    status.Update(rejected_);
    const Lock lock(mutex_);
    over = abandoned_ || (finishing_ && state_.IsComplete());
  }
  Lock lock(mutex_);
  if (abandoned_) status = absl::CancelledError("the session was abandoned");
  const bool is_reported = !abandoned_ && state_.info().has_value();
  lock.unlock();
  if (is_reported && callbacks_.on_end) callbacks_.on_end(status);
  lock.lock();
  ended_ = std::move(status);
  changed_.notify_all();
}

// Runs streams until one that worked ends; returns OK then. Otherwise, returns why no stream could
// be opened, or why the session may not go on.
absl::Status LiveSessionImpl::RunUntilBroken() {
  const bool resumes = broken_;
  const ClientOptions& options = settings_.client;
  const absl::Time deadline = settings_.environment.now() + options.deadline;
  return Retry(resumes ? ForResuming(options.retry) : options.retry, InterruptibleEnvironment(),
               resumes ? Priority::kBulk : Priority::kInteractive,
               {deadline, options.wait, options.server_address}, [this] { return RunStream(); });
}

RetryEnvironment LiveSessionImpl::InterruptibleEnvironment() {
  RetryEnvironment environment = settings_.environment;
  environment.sleep = [this](absl::Duration wait) {
    while (wait > absl::ZeroDuration()) {
      {
        const Lock lock(mutex_);
        if (abandoned_) return;
      }
      const absl::Duration slice = std::min(wait, kSleepSlice);
      settings_.environment.sleep(slice);
      wait -= slice;
    }
  };
  return environment;
}

bool LiveSessionImpl::HasProof(SteadyTime opened, int delivered_before) const {
  return state_.delivered() > delivered_before ||
         std::chrono::steady_clock::now() - opened >= absl::ToChronoNanoseconds(settings_.proof);
}

// Returns OK if the session is over, or if the stream worked before it broke.
AttemptEnd LiveSessionImpl::RunStream() {
  if (!OpenStream()) return absl::OkStatus();
  const SteadyTime opened = std::chrono::steady_clock::now();
  const int delivered_before = state_.delivered();  // only this thread changes it
  v1::SynthesizeLiveResponse response;
  for (bool wanted = true; stream_->Read(&response);) {
    if (!wanted) continue;  // cancelled; drop what still arrives
    wanted = Handle(response);
    if (!wanted) context_->TryCancel();
  }
  absl::Status ended = CloseStream();
  Lock lock(mutex_);
  if (!rejected_.ok()) return absl::OkStatus();  // whatever its code, it is not retried
  if (abandoned_ || (finishing_ && state_.IsComplete())) return absl::OkStatus();
  const bool was_open = state_.is_open();
  if (absl::IsNotFound(ended) && broken_) {
    return WithPayloadsOf(
        ended, absl::AbortedError(absl::StrCat("the session broke after ", state_.delivered(),
                                               " frames and cannot be resumed: ", info_.model_name,
                                               "@", info_.model_version, " is no longer served")));
  }
  const bool may_retry =
      IsRetryable(ended, Priority::kBulk) && settings_.client.retry.max_attempts > 1;
  if (!was_open || !may_retry) return {WithoutDelay(std::move(ended)), was_open};
  broken_ = true;
  const bool worked = HasProof(opened, delivered_before);
  const std::string message(ended.message());
  lock.unlock();
  if (!draining_) Notify(LiveNotice::Kind::kInterrupted, message);
  if (worked) return absl::OkStatus();
  return {WithoutDelay(std::move(ended)), was_open};
}

bool LiveSessionImpl::OpenStream() {
  const Lock lock(mutex_);
  if (abandoned_) return false;
  context_ = NewContext(absl::InfiniteFuture(), settings_.client.token, request_id_);
  stream_ = stub_->SynthesizeLive(context_.get());
  outgoing_ = state_.BeginStream();
  can_write_ = true;
  half_closed_ = silent_ = draining_ = false;
  heard_ = std::chrono::steady_clock::now();
  changed_.notify_all();
  return true;
}

// Returns false if the stream is to be cancelled.
bool LiveSessionImpl::Handle(const v1::SynthesizeLiveResponse& response) {
  absl::StatusOr<LiveAnswer> answer;
  bool opened = false;
  {
    const Lock lock(mutex_);
    heard_ = std::chrono::steady_clock::now();
    const bool was_open = state_.is_open();
    answer = state_.Accept(response);
    opened = !was_open && state_.is_open();
    if (opened && !broken_) info_ = *state_.info();
    changed_.notify_all();
  }
  if (!answer.ok()) {
    rejected_ = answer.status();
    return false;
  }
  if (opened && broken_) Notify(LiveNotice::Kind::kResumed);
  if (answer->frames.has_value()) rejected_ = callbacks_.on_frames(*answer->frames);
  if (!rejected_.ok()) return false;
  if (!answer->notice.has_value()) return true;
  if (callbacks_.on_notice) callbacks_.on_notice(*answer->notice);
  draining_ = answer->notice->kind == LiveNotice::Kind::kDraining;
  return !draining_;
}

// Waits for the writer, and returns how the stream ended: OK is an early end, too.
absl::Status LiveSessionImpl::CloseStream() {
  std::unique_ptr<grpc::ClientContext> context;
  std::unique_ptr<Stream> stream;
  bool silent = false;
  {
    Lock lock(mutex_);
    can_write_ = false;
    changed_.wait(lock, [this] { return !writing_; });
    context = std::move(context_);
    stream = std::move(stream_);
    silent = silent_;
  }
  const absl::Status ended = FromGrpc(stream->Finish());
  if (!ended.ok() && !IsBrokenConnection(ended)) return ended;
  if (!ended.ok() && !state_.is_open() && !silent) return ended;
  absl::Status broken = absl::UnavailableError(absl::StrCat(
      "the session's stream ended after ", state_.delivered(), " frames: ",
      draining_    ? "the server shuts down"
      : silent     ? absl::StrCat("no answer for ", absl::FormatDuration(settings_.longest_silence))
      : ended.ok() ? std::string("the server ended it")
                   : std::string(ended.message())));
  return WithPayloadsOf(ended, std::move(broken));
}

void LiveSessionImpl::Notify(LiveNotice::Kind kind, const std::string& message) {
  if (callbacks_.on_notice) callbacks_.on_notice({kind, {}, message});
}

// ---- The writer. ----

bool LiveSessionImpl::HasWork() const {
  return can_write_ && (!outgoing_.empty() || (finishing_ && !half_closed_));
}

void LiveSessionImpl::Write() {
  Lock lock(mutex_);
  while (!abandoned_ && !ended_.has_value()) {
    if (HasWork()) {
      WriteOne(&lock);
      continue;
    }
    changed_.wait_for(lock, SilenceCheckPeriod(),
                      [this] { return HasWork() || abandoned_ || ended_.has_value(); });
    CheckSilence();
  }
}

void LiveSessionImpl::WriteOne(Lock* lock) {
  Stream& stream = *stream_;  // stays while writing_ is true
  writing_ = true;
  bool written = false;
  if (outgoing_.empty()) {
    half_closed_ = true;
    lock->unlock();
    written = stream.WritesDone();
  } else {
    const v1::SynthesizeLiveRequest message = std::move(outgoing_.front());
    outgoing_.pop_front();
    lock->unlock();
    written = stream.Write(message);
  }
  lock->lock();
  writing_ = false;
  if (!written) can_write_ = false;  // the reader finds out why
  changed_.notify_all();
}

std::chrono::nanoseconds LiveSessionImpl::SilenceCheckPeriod() const {
  return absl::ToChronoNanoseconds(settings_.longest_silence) / 4;
}

void LiveSessionImpl::CheckSilence() {
  if (stream_ == nullptr || silent_) return;
  if (state_.is_open() && !state_.IsDue() && !half_closed_) return;
  const auto silence = std::chrono::steady_clock::now() - heard_;
  if (silence < absl::ToChronoNanoseconds(settings_.longest_silence)) return;
  silent_ = true;
  context_->TryCancel();
}

}  // namespace duet::client::internal
