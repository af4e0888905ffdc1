#include "server/service/synthesis_call.h"

#include <string>
#include <utility>

#include "server/service/refusals.h"

namespace duet::server::service {
namespace {

// Failures of a window that are the model's, not the caller's or the server's own.
bool IsModelFailure(const absl::Status& status) {
  return !absl::IsCancelled(status) && !absl::IsDeadlineExceeded(status) &&
         !absl::IsUnavailable(status);
}

}  // namespace

std::shared_ptr<SynthesisCall> SynthesisCall::Create(Parts parts,
                                                     batching::WindowScheduler& scheduler,
                                                     ReplyWriter& writer) {
  ClipStreamOptions options;
  options.priority = parts.request.priority;
  options.deadline = parts.deadline;
  options.buffered_frames = parts.buffered_frames;
  options.client = parts.client;
  engine::ClipRequest clip = std::move(parts.request.clip);
  std::shared_ptr<SynthesisCall> call(new SynthesisCall(std::move(parts), clip.options, writer));
  // The clip outlives a finished call while its last window runs; it must not keep it.
  call->stream_ = std::make_shared<ClipStream>(call->model_, std::move(clip), options, scheduler,
                                               [weak = std::weak_ptr<SynthesisCall>(call)] {
                                                 if (const auto alive = weak.lock())
                                                   alive->Advance();
                                               });
  return call;
}

SynthesisCall::SynthesisCall(Parts parts, const engine::SynthesisOptions& options,
                             ReplyWriter& writer)
    : model_(std::move(parts.model)),
      reply_mapping_(std::move(parts.request.reply)),
      chunk_frames_(parts.request.chunk_frames),
      deadline_(parts.deadline),
      write_timeout_seconds_(parts.write_timeout_seconds),
      clock_(*parts.clock),
      writer_(writer),
      place_(std::move(parts.place)),
      held_bytes_(std::move(parts.held_bytes)),
      scope_(std::move(parts.scope)) {
  metrics::CallRecord& record = scope_->record();
  record.model = model_->description().name;
  record.version = model_->description().version;
  record.priority = PriorityName(parts.request.priority);
  record.seed = options.sampling.seed;
  record.variety = options.sampling.variety;
  record.clean_up = options.clean_up.value_or(false);
}

void SynthesisCall::Start() {
  const absl::Status scheduled = stream_->Start();
  if (!scheduled.ok()) Abort(QueueRefusal(scheduled));
  Advance();
}

void SynthesisCall::OnWritten(bool ok) {
  {
    common::MutexLock lock(mutex_);
    state_ = State::kIdle;
    if (!ok && !end_.has_value()) end_ = absl::CancelledError("the caller went away");
    if (!ok) stream_->Cancel();
  }
  Advance();
}

void SynthesisCall::Abort(const absl::Status& reason) {
  {
    common::MutexLock lock(mutex_);
    if (!end_.has_value()) end_ = reason;
  }
  stream_->Cancel();
  Advance();
}

void SynthesisCall::CheckTime(common::TimePoint now) {
  std::optional<absl::Status> break_off;
  {
    common::MutexLock lock(mutex_);
    if (state_ == State::kFinished || breaking_off_) return;
    breaking_off_ = EndLate(now);
    if (!end_.has_value()) return;
    if (breaking_off_) break_off = end_;
  }
  if (break_off.has_value()) return BreakOff(*break_off);
  stream_->Cancel();
  Advance();
}

std::optional<common::TimePoint> SynthesisCall::waiting_since() const {
  common::MutexLock lock(mutex_);
  if (state_ != State::kWriting || given_up_) return std::nullopt;
  return write_began_;
}

std::optional<std::size_t> SynthesisCall::GiveUpReader(common::TimePoint now, double seconds) {
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
    // Somebody else waits for the place. The bytes are held until the call has let go of them.
    place = std::move(place_);
    bytes = held_bytes_.amount();
  }
  BreakOff(reason);
  return bytes;
}

void SynthesisCall::BreakOff(const absl::Status& reason) {
  stream_->Cancel();
  writer_.BreakOff(reason);
  {
    common::MutexLock lock(mutex_);
    breaking_off_ = false;
  }
  Advance();
}

bool SynthesisCall::EndLate(common::TimePoint now) {
  if (now >= deadline_ && !end_.has_value()) {
    end_ = absl::DeadlineExceededError(
        "the call's deadline passed, or it took longer than the server answers any call");
  }
  const bool stalled = state_ == State::kWriting &&
                       common::SecondsBetween(write_began_, now) >= write_timeout_seconds_;
  if (stalled && !end_.has_value()) end_ = WriteTimeoutRefusal(write_timeout_seconds_);
  return stalled;
}

void SynthesisCall::Advance() {
  // The writer's Finish may drop the last other reference.
  const std::shared_ptr<SynthesisCall> self = shared_from_this();
  std::optional<absl::Status> end;
  {
    common::MutexLock lock(mutex_);
    if (state_ != State::kIdle || breaking_off_) return;
    const bool write = !end_.has_value() && PrepareReply();
    if (!write && !end_.has_value()) return;
    state_ = write ? State::kWriting : State::kFinished;
    if (write) write_began_ = clock_.Now();
    if (!write) end = end_;
  }
  if (end.has_value()) {
    Finish(*end);
  } else {
    writer_.Write(reply_);
  }
}

bool SynthesisCall::PrepareReply() {
  switch (next_) {
    case Next::kHeader:
      PrepareHeader();
      next_ = Next::kFrames;
      return true;
    case Next::kFrames:
      return PrepareFrames();
    case Next::kEnd:
      end_ = absl::OkStatus();
      break;
  }
  return false;
}

bool SynthesisCall::PrepareFrames() {
  const ClipPart part = stream_->Take(chunk_frames_);
  switch (part.kind) {
    case ClipPart::Kind::kPending:
      return false;
    case ClipPart::Kind::kFrames:
      PrepareChunk(part);
      return true;
    case ClipPart::Kind::kEnd:
      PrepareSummary();
      next_ = Next::kEnd;
      return true;
    case ClipPart::Kind::kFailed:
      break;
  }
  if (IsModelFailure(part.error)) {
    scope_->record().cause = part.error.ToString();
    end_ = ModelFailedRefusal(scope_->record().request_id);
  } else {
    end_ = absl::IsUnavailable(part.error) ? DrainingRefusal() : part.error;
  }
  return false;
}

void SynthesisCall::PrepareHeader() {
  v1::SynthesisHeader& header = *reply_.mutable_header();
  const engine::ModelDescription& model = model_->description();
  header.set_model_name(model.name);
  header.set_model_version(static_cast<uint32_t>(model.version));
  for (const std::string& name : reply_mapping_.joint_names) header.add_joint_names(name);
  header.set_frame_rate_hz(reply_mapping_.frame_rate_hz);
  header.set_unit(reply_mapping_.unit);
  header.set_up_axis(reply_mapping_.up_axis);
  header.set_frame_count(static_cast<uint32_t>(stream_->frame_count()));
  for (const std::string& name : model.classes) header.add_interaction_classes(name);
  const metrics::CallRecord& record = scope_->record();
  header.set_request_id(record.request_id);
  header.set_seed(record.seed);
  header.set_variety(record.variety);
  header.set_clean_up(record.clean_up ? v1::CLEAN_UP_ON : v1::CLEAN_UP_OFF);
}

void SynthesisCall::PrepareChunk(const ClipPart& part) {
  metrics::CallRecord& record = scope_->record();
  if (record.chunks == 0) record.first_chunk_seconds = scope_->ElapsedSeconds();
  v1::MotionChunk& chunk = *reply_.mutable_chunk();
  chunk.Clear();
  FillChunk(reply_mapping_, part.poses, record.frames, chunk);
  ++record.chunks;
  record.frames += static_cast<int>(chunk.frame_count());
}

void SynthesisCall::PrepareSummary() {
  const ClipStreamStats stats = stream_->stats();
  const metrics::CallRecord& record = scope_->record();
  v1::SynthesisSummary& summary = *reply_.mutable_summary();
  summary.set_frame_count(static_cast<uint32_t>(record.frames));
  summary.set_chunk_count(static_cast<uint32_t>(record.chunks));
  summary.set_window_count(static_cast<uint32_t>(stats.windows));
  summary.set_queue_seconds(stats.queue_seconds);
  summary.set_compute_seconds(stats.compute_seconds);
  if (stats.unfamiliarity) summary.set_unfamiliarity(*stats.unfamiliarity);
}

void SynthesisCall::Finish(const absl::Status& status) {
  ShareLease place, held_bytes;
  std::unique_ptr<CallScope> scope;
  {
    common::MutexLock lock(mutex_);
    place = std::move(place_);
    held_bytes = std::move(held_bytes_);
    scope = std::move(scope_);
  }
  const ClipStreamStats stats = stream_->stats();
  metrics::CallRecord& record = scope->record();
  record.windows = stats.windows;
  record.queue_seconds = stats.queue_seconds;
  record.compute_seconds = stats.compute_seconds;
  record.peak_buffered_frames = stats.peak_buffered_frames;
  record.unfamiliarity = stats.unfamiliarity;
  // The place is free before the call is reported, and the call is reported before its caller gets
  // the status: none of them is seen without the one before. Under no lock: observers may be slow.
  place = ShareLease();
  held_bytes = ShareLease();
  writer_.Finish(*scope, status);
}

}  // namespace duet::server::service
