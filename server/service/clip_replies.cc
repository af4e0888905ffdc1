#include "server/service/clip_replies.h"

#include <cstdint>
#include <string>
#include <utility>

#include "model/engine/candidates.h"
#include "server/service/refusals.h"
#include "server/service/reply_mapping.h"

namespace duet::server::service {
namespace {

// The status that ends the call after one of its windows failed.
absl::Status EndAfter(const absl::Status& error, metrics::CallRecord& record) {
  return WindowFailure(error, record.request_id, &record.cause);
}

ClipStreamOptions WithPriority(ClipStreamOptions options, batching::Priority priority) {
  options.priority = priority;
  return options;
}

v1::MotionGrade ToMessage(const body::Grade& grade) {
  v1::MotionGrade message;
  message.set_twisted(static_cast<float>(grade.twisted));
  message.set_skating(static_cast<float>(grade.skating));
  message.set_leader_skating(static_cast<float>(grade.leader_skating));
  message.set_overlapping(static_cast<float>(grade.overlapping));
  for (const body::FrameRun& run : grade.bad_runs) {
    v1::FrameRun& added = *message.add_bad_runs();
    added.set_first_frame(static_cast<uint32_t>(run.first));
    added.set_frame_count(static_cast<uint32_t>(run.count));
  }
  return message;
}

}  // namespace

ClipReplies::ClipReplies(std::shared_ptr<const engine::Synthesizer> model, ValidatedRequest request,
                         ClipStreamOptions options, batching::WindowScheduler& scheduler,
                         ServerBuild build)
    : model_(std::move(model)),
      options_(request.clip.options),
      priority_(request.priority),
      mapping_(std::move(request.reply)),
      chunk_frames_(request.chunk_frames),
      build_(std::move(build)),
      on_progress_(std::make_shared<std::function<void()>>()),
      stream_(std::make_shared<ClipStream>(model_, std::move(request.clip),
                                           WithPriority(std::move(options), priority_), scheduler,
                                           [on_progress = on_progress_] { (*on_progress)(); })) {}

absl::Status ClipReplies::Start(SourceEvents events) {
  *on_progress_ = std::move(events.on_progress);
  const absl::Status scheduled = stream_->Start();
  return scheduled.ok() ? scheduled : QueueRefusal(scheduled);
}

NextReply ClipReplies::Next(CallScope& scope) {
  switch (next_) {
    case Part::kHeader:
      return NextHeader(scope);
    case Part::kFrames:
      return NextFrames(scope);
    case Part::kEnd:
      break;
  }
  return {nullptr, absl::OkStatus()};
}

NextReply ClipReplies::NextHeader(CallScope& scope) {
  if (mapping_.rig) {
    first_part_ = stream_->Take(chunk_frames_);
    if (first_part_.kind == ClipPart::Kind::kPending) return {};
    if (first_part_.kind == ClipPart::Kind::kFailed) {
      return {nullptr, EndAfter(first_part_.error, scope.record())};
    }
    rig_ = std::make_unique<ReplyRig>(*mapping_.rig, mapping_.coordinates, mapping_.levelling,
                                      mapping_.joints, first_part_.poses);
  }
  FillHeader(scope.record());
  next_ = Part::kFrames;
  return {&reply_, {}};
}

NextReply ClipReplies::NextFrames(CallScope& scope) {
  // Pending unless it is the first part of a reply with rotations.
  ClipPart part = std::exchange(first_part_, {});
  if (part.kind == ClipPart::Kind::kPending) part = stream_->Take(chunk_frames_);
  switch (part.kind) {
    case ClipPart::Kind::kPending:
      return {};
    case ClipPart::Kind::kFrames:
      FillChunk(std::move(part), scope);
      return {&reply_, {}};
    case ClipPart::Kind::kEnd:
      FillSummary(scope.record());
      next_ = Part::kEnd;
      return {&reply_, {}};
    case ClipPart::Kind::kFailed:
      break;
  }
  return {nullptr, EndAfter(part.error, scope.record())};
}

void ClipReplies::FillHeader(const metrics::CallRecord& record) {
  v1::SynthesisHeader& header = *reply_.mutable_header();
  const engine::ModelDescription& model = model_->description();
  header.set_model_name(model.name);
  header.set_model_version(static_cast<uint32_t>(model.version));
  for (const std::string& name : mapping_.joint_names) header.add_joint_names(name);
  header.set_frame_rate_hz(mapping_.frame_rate_hz);
  header.set_unit(mapping_.unit);
  header.set_up_axis(mapping_.up_axis);
  header.set_frame_count(static_cast<uint32_t>(stream_->frame_count()));
  for (const std::string& name : model.classes) header.add_interaction_classes(name);
  header.set_request_id(record.request_id);
  header.set_seed(options_.sampling.seed);
  header.set_variety(options_.sampling.variety);
  header.set_candidates(static_cast<uint32_t>(Candidates()));
  if (rig_ != nullptr) rig_->FillHeader(header);
  header.set_engine(build_.engine);
  header.set_server_version(build_.version);
  header.set_clean_up(options_.clean_up.value_or(false) ? v1::CLEAN_UP_ON : v1::CLEAN_UP_OFF);
}

void ClipReplies::FillChunk(ClipPart part, CallScope& scope) {
  metrics::CallRecord& record = scope.record();
  if (record.chunks == 0) record.first_chunk_seconds = scope.ElapsedSeconds();
  v1::MotionChunk& chunk = *reply_.mutable_chunk();
  chunk.Clear();
  if (rig_ != nullptr) rig_->AddRotations(&part.poses, chunk);
  service::FillChunk(mapping_, part.poses, record.frames, chunk);
  ++record.chunks;
  record.frames += static_cast<int>(chunk.frame_count());
}

void ClipReplies::FillSummary(const metrics::CallRecord& record) {
  const ClipStreamStats stats = stream_->stats();
  v1::SynthesisSummary& summary = *reply_.mutable_summary();
  summary.set_frame_count(static_cast<uint32_t>(record.frames));
  summary.set_chunk_count(static_cast<uint32_t>(record.chunks));
  summary.set_window_count(static_cast<uint32_t>(stats.windows));
  summary.set_queue_seconds(stats.queue_seconds);
  summary.set_compute_seconds(stats.compute_seconds);
  if (stats.unfamiliarity) summary.set_unfamiliarity(*stats.unfamiliarity);
  if (stats.grade) *summary.mutable_grade() = ToMessage(*stats.grade);
  summary.mutable_constraint_metres()->Assign(stats.pin_distances.begin(),
                                              stats.pin_distances.end());
}

int ClipReplies::Candidates() const {
  return engine::CandidateCount(model_->description(), options_.sampling);
}

void ClipReplies::Report(metrics::CallRecord& record) const {
  record.model = model_->description().name;
  record.version = model_->description().version;
  record.priority = PriorityName(priority_);
  record.seed = options_.sampling.seed;
  record.variety = options_.sampling.variety;
  record.candidates = Candidates();
  record.clean_up = options_.clean_up.value_or(false);
  const ClipStreamStats stats = stream_->stats();
  record.windows = stats.windows;
  record.queue_seconds = stats.queue_seconds;
  record.compute_seconds = stats.compute_seconds;
  record.peak_buffered_frames = stats.peak_buffered_frames;
  record.unfamiliarity = stats.unfamiliarity;
}

}  // namespace duet::server::service
