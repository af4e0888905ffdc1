#include "client/live/live_run.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "absl/time/clock.h"

namespace duet::client::live {

absl::StatusOr<LeaderFormat> ClipSource::Open() {
  return LeaderFormat{clip_.joint_names, clip_.frame_rate_hz};
}

// Returns false if Stop was called.
bool ClipSource::WaitForFrame() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!realtime_) return !stopped_;
  // From the first call on, which follows the beginning of the session.
  if (next_ == 0) begin_ = std::chrono::steady_clock::now();
  const auto due =
      begin_ + std::chrono::nanoseconds(static_cast<int64_t>(next_ * 1e9 / clip_.frame_rate_hz));
  return !stopping_.wait_until(lock, due, [this] { return stopped_; });
}

absl::StatusOr<std::optional<LeaderEvent>> ClipSource::Next() {
  if (next_ >= clip_.frame_count() || !WaitForFrame()) return std::nullopt;
  const auto pose = clip_.poses[next_];
  return LeaderFrame{next_++, {pose.begin(), pose.end()}};
}

void ClipSource::Stop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  stopped_ = true;
  stopping_.notify_all();
}

absl::StatusOr<LiveReport> LiveRun::Run(const Client& client, LiveRequest request) {
  absl::StatusOr<LeaderFormat> format = source_->Open();
  if (!format.ok()) return format.status();
  request.joint_names = format->joint_names;
  request.frame_rate_hz = report_.frame_rate_hz = format->frame_rate_hz;
  delay_frames_ = request.delay_frames;
  for (FollowerSink* sink : sinks_) {
    absl::Status status = sink->Start(*format);
    if (!status.ok()) return status;
  }
  absl::Status status = RunSession(client, request);
  report_.notes = source_->Notes();
  status.Update(FinishSinks());
  if (!status.ok()) return status;
  return report_;
}

absl::Status LiveRun::RunSession(const Client& client, const LiveRequest& request) {
  LiveCallbacks callbacks;
  callbacks.on_frames = [this](const LiveFrames& frames) { return Accept(frames); };
  callbacks.on_notice = on_notice_;
  callbacks.on_end = [this](const absl::Status&) { End(); };
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    begin_ = absl::Now();
  }
  absl::StatusOr<std::unique_ptr<LiveSession>> session =
      client.StartLive(request, std::move(callbacks));
  if (!session.ok()) return session.status();
  report_.info = (*session)->info();
  const absl::Status followed = Follow(session->get());
  // The frames that are due arrive even if the source failed.
  const absl::StatusOr<LiveSummary> summary = (*session)->Finish();
  if (!summary.ok()) return summary.status();
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.summary = *summary;
  report_.time = absl::Now() - begin_;
  return followed;
}

absl::Status LiveRun::Follow(LiveSession* session) {
  for (;;) {
    absl::StatusOr<std::optional<LeaderEvent>> event = source_->Next();
    if (!event.ok()) return event.status();
    if (!event->has_value()) return absl::OkStatus();
    absl::Status status;
    if (const auto* frame = std::get_if<LeaderFrame>(&**event)) {
      status = Send(session, *frame);
    } else {
      const auto& labels = std::get<LabelCommand>(**event);
      status = session->ChangeLabels(labels.weights, labels.ease);
    }
    if (!status.ok()) return status;
    if (!source_->IsLive()) WaitForAnswers();
  }
}

absl::Status LiveRun::Send(LiveSession* session, const LeaderFrame& frame) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    sent_end_ = std::max(sent_end_, frame.index + 1);
    for (FollowerSink* sink : sinks_) sink->AcceptLeader(frame);
  }
  return session->Send(frame.index, frame.positions, /*capture_seconds=*/0);
}

void LiveRun::WaitForAnswers() {
  std::unique_lock<std::mutex> lock(mutex_);
  answered_.wait(lock, [this] { return ended_ || answered_end_ >= sent_end_ - delay_frames_; });
}

// Finish returns why the session has ended.
void LiveRun::End() {
  source_->Stop();
  const std::lock_guard<std::mutex> lock(mutex_);
  ended_ = true;
  answered_.notify_all();
}

absl::Status LiveRun::Accept(const LiveFrames& frames) {
  const std::lock_guard<std::mutex> lock(mutex_);
  answered_end_ = frames.first_frame + frames.poses.frame_count();
  absl::Status status;
  for (FollowerSink* sink : sinks_) status.Update(sink->Accept(frames));
  answered_.notify_all();
  return status;
}

absl::Status LiveRun::FinishSinks() {
  const std::lock_guard<std::mutex> lock(mutex_);
  absl::Status status;
  for (FollowerSink* sink : sinks_) {
    const absl::StatusOr<std::vector<std::string>> written = sink->Finish(report_.info);
    status.Update(written.status());
    if (!written.ok()) continue;
    report_.written.insert(report_.written.end(), written->begin(), written->end());
  }
  return status;
}

}  // namespace duet::client::live
