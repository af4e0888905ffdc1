#include "client/live/capture_source.h"

#include <chrono>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "model/motion/poses.h"

namespace duet::client::live {
namespace {

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

absl::StatusOr<std::unique_ptr<CaptureSource>> CaptureSource::Create(CaptureOptions options) {
  absl::StatusOr<std::unique_ptr<capture::UdpReceiver>> receiver =
      capture::UdpReceiver::Bind(options.address.host, options.address.port);
  if (!receiver.ok()) return receiver.status();
  return std::unique_ptr<CaptureSource>(
      new CaptureSource(std::move(options), *std::move(receiver)));
}

CaptureSource::CaptureSource(CaptureOptions options, std::unique_ptr<capture::UdpReceiver> receiver)
    : options_(std::move(options)),
      receiver_(std::move(receiver)),
      stream_([protocol = options_.address.protocol] { return MakeStreamReader(protocol); },
              options_.frame_rate_hz) {}

absl::StatusOr<LeaderFormat> CaptureSource::Open() {
  if (options_.on_note) {
    capture::CaptureAddress address = options_.address;
    address.port = receiver_->port();
    options_.on_note(absl::StrCat("waiting for frames at ", FormatCaptureAddress(address)));
  }
  absl::StatusOr<std::optional<capture::TimedFrame>> frame = NextFrame();
  if (!frame.ok()) return frame.status();
  // Not UNAVAILABLE, which the server would be.
  if (!frame->has_value()) {
    return absl::CancelledError(
        absl::StrCat("interrupted before the first frame: ", stream_.Summary()));
  }
  const motion::Poses pose(static_cast<int>((*frame)->positions.size()), (*frame)->positions);
  absl::StatusOr<retargeting::JointMap> map =
      retargeting::MapJoints(FormatCaptureAddress(options_.address), stream_.joint_names(), pose,
                             options_.skeleton, options_.joints);
  if (!map.ok()) return map.status();
  map_ = *std::move(map);
  first_ = *std::move(frame);
  return LeaderFormat{options_.skeleton.joint_names, stream_.rate_hz()};
}

absl::StatusOr<std::optional<LeaderEvent>> CaptureSource::Next() {
  std::optional<capture::TimedFrame> frame = std::exchange(first_, std::nullopt);
  if (!frame.has_value()) {
    absl::StatusOr<std::optional<capture::TimedFrame>> next = NextFrame();
    if (!next.ok()) return next.status();
    if (!next->has_value()) return std::nullopt;
    frame = *std::move(next);
  }
  const absl::Time captured = absl::Now() - absl::Seconds(Now() - frame->capture_seconds);
  return LeaderFrame{frame->index, ApplyJointMap(*map_, frame->positions), captured};
}

// Absent if Stop was called.
absl::StatusOr<std::optional<capture::TimedFrame>> CaptureSource::NextFrame() {
  while (!receiver_->stopped()) {
    const double now = Now();
    std::optional<capture::TimedFrame> frame = stream_.Next(now);
    ReportNotes();
    if (frame.has_value()) return frame;
    absl::StatusOr<std::optional<capture::UdpReceiver::Datagram>> datagram =
        receiver_->Receive(stream_.NextDue() - now);
    if (!datagram.ok()) return datagram.status();
    if (!datagram->has_value()) continue;
    stream_.Receive((*datagram)->bytes, (*datagram)->sender, Now());
  }
  return std::nullopt;
}

void CaptureSource::ReportNotes() {
  for (const std::string& note : stream_.TakeNotes()) {
    if (options_.on_note) options_.on_note(note);
  }
}

std::vector<std::string> CaptureSource::Notes() const {
  std::vector<std::string> notes = map_.has_value() ? map_->notes : std::vector<std::string>();
  notes.push_back(stream_.Summary());
  return notes;
}

}  // namespace duet::client::live
