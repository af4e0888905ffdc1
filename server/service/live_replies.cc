#include "server/service/live_replies.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "model/engine/candidates.h"
#include "server/service/refusals.h"
#include "server/service/validator.h"
#include "server/service/wire.h"

namespace duet::server::service {
namespace {

// Far above ten seconds of any skeleton at any rate.
constexpr std::size_t kMaxMessageBytes = std::size_t{1} << 20;

absl::StatusOr<v1::SynthesizeLiveRequest> Parse(grpc::ByteBuffer bytes) {
  if (bytes.Length() > kMaxMessageBytes) {
    return LiveMessageTooLargeRefusal(bytes.Length(), kMaxMessageBytes);
  }
  v1::SynthesizeLiveRequest message;
  const absl::Status parsed = ParseMessage(std::move(bytes), message);
  if (!parsed.ok()) return parsed;
  return message;
}

}  // namespace

v1::LiveHeader MakeLiveHeader(const engine::ModelDescription& model,
                              const ValidatedLiveStart& start) {
  const engine::SynthesisOptions& options = start.live.options;
  v1::LiveHeader header;
  header.set_model_name(model.name);
  header.set_model_version(static_cast<uint32_t>(model.version));
  for (const std::string& name : start.reply.joint_names) header.add_joint_names(name);
  header.set_frame_rate_hz(start.reply.frame_rate_hz);
  header.set_unit(start.reply.unit);
  header.set_up_axis(start.reply.up_axis);
  for (const std::string& name : model.classes) header.add_interaction_classes(name);
  header.set_seed(options.sampling.seed);
  header.set_variety(options.sampling.variety);
  header.set_clean_up(options.clean_up.value_or(false) ? v1::CLEAN_UP_ON : v1::CLEAN_UP_OFF);
  header.set_candidates(static_cast<uint32_t>(engine::CandidateCount(model, options.sampling)));
  header.set_delay_frames(static_cast<uint32_t>(start.live.delay_frames));
  return header;
}

absl::Status LiveReplies::ErrorOf(const LiveOutput& output, metrics::CallRecord& record) {
  switch (output.fault) {
    case LiveFault::kQueue:
      return QueueRefusal(output.error);
    case LiveFault::kWindow:
      return WindowFailure(output.error, record.request_id, &record.cause);
    case LiveFault::kMessage:
      break;
  }
  return output.error;
}

LiveReplies::LiveReplies(std::shared_ptr<LiveSession> session, v1::LiveHeader header,
                         std::shared_ptr<const engine::Synthesizer> model,
                         engine::SynthesisOptions options, const common::Clock& clock)
    : session_(std::move(session)),
      model_(std::move(model)),
      options_(options),
      clock_(clock),
      header_(std::move(header)) {
  header_.set_first_frame(static_cast<uint32_t>(session_->first_frame()));
  header_.set_history_frames(static_cast<uint32_t>(session_->history_frames()));
}

absl::Status LiveReplies::Start(SourceEvents events) {
  session_->Start(std::move(events.on_progress));
  session_->Read(std::move(events.read_next));
  return absl::OkStatus();
}

void LiveReplies::OnMessage(grpc::ByteBuffer bytes) {
  session_->OnMessage(Parse(std::move(bytes)));
}

NextReply LiveReplies::Next(CallScope& scope) {
  if (!sent_header_) {
    sent_header_ = true;
    header_.set_request_id(scope.record().request_id);
    reply_.mutable_header()->Swap(&header_);
    return {&reply_, {}};
  }
  if (sent_summary_) return {nullptr, absl::OkStatus()};
  LiveOutput output = session_->Take();
  if (output.notice) {
    *reply_.mutable_notice() = *std::move(output.notice);
    return {&reply_, {}};
  }
  if (output.frames) return FramesReply(std::move(output), scope);
  if (!output.error.ok()) return {nullptr, ErrorOf(output, scope.record())};
  return output.end ? SummaryReply(scope.record()) : NextReply{};
}

NextReply LiveReplies::FramesReply(LiveOutput output, CallScope& scope) {
  metrics::CallRecord& record = scope.record();
  const double seconds = common::SecondsBetween(output.arrival, clock_.Now());
  output.frames->set_server_seconds(static_cast<float>(seconds));
  // A session begins long before its first leader frame.
  if (record.chunks == 0) record.first_chunk_seconds = seconds;
  ++record.chunks;
  record.frames += static_cast<int>(output.frames->frame_count());
  *reply_.mutable_frames() = *std::move(output.frames);
  return {&reply_, {}};
}

NextReply LiveReplies::SummaryReply(const metrics::CallRecord& record) {
  sent_summary_ = true;
  const LiveStats stats = session_->stats();
  v1::LiveSummary& summary = *reply_.mutable_summary();
  summary.set_frame_count(static_cast<uint32_t>(record.frames));
  summary.set_window_count(static_cast<uint32_t>(stats.windows));
  summary.set_queue_seconds(stats.queue_seconds);
  summary.set_compute_seconds(stats.compute_seconds);
  summary.set_gap_frames(static_cast<uint32_t>(stats.gap_frames));
  summary.set_late_frames(static_cast<uint32_t>(stats.late_frames));
  summary.set_skipped_frames(static_cast<uint32_t>(stats.skipped_frames));
  return {&reply_, {}};
}

void LiveReplies::Report(metrics::CallRecord& record) const {
  record.model = model_->description().name;
  record.version = model_->description().version;
  record.priority = PriorityName(batching::Priority::kInteractive);
  record.seed = options_.sampling.seed;
  record.variety = options_.sampling.variety;
  record.candidates = engine::CandidateCount(model_->description(), options_.sampling);
  record.clean_up = options_.clean_up.value_or(false);
  const LiveStats stats = session_->stats();
  record.windows = stats.windows;
  record.queue_seconds = stats.queue_seconds;
  record.compute_seconds = stats.compute_seconds;
  record.peak_buffered_frames = stats.peak_buffered_frames;
}

}  // namespace duet::server::service
