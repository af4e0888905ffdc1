#include "client/live/vmc_sink.h"

#include "absl/strings/str_cat.h"

namespace duet::client::live {

absl::Status VmcSink::Check(const capture::CaptureAddress& address) {
  if (address.protocol == capture::CaptureProtocol::kVmc && !address.host.empty()) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("expected vmc://HOST[:PORT], got ", FormatCaptureAddress(address)));
}

absl::StatusOr<std::unique_ptr<VmcSink>> VmcSink::Create(const capture::CaptureAddress& address) {
  absl::Status status = Check(address);
  if (!status.ok()) return status;
  absl::StatusOr<capture::UdpSender> sender =
      capture::UdpSender::Connect(address.host, address.port);
  if (!sender.ok()) return sender.status();
  return std::unique_ptr<VmcSink>(new VmcSink(FormatCaptureAddress(address), *std::move(sender)));
}

absl::Status VmcSink::Start(const LeaderFormat& format) {
  frame_rate_hz_ = format.frame_rate_hz;
  writer_ = std::make_unique<capture::VmcWriter>(format.joint_names, format.frame_rate_hz);
  return absl::OkStatus();
}

absl::Status VmcSink::Accept(const LiveFrames& frames) {
  for (int i = 0; i < frames.poses.frame_count(); ++i) {
    const absl::StatusOr<std::vector<std::string>> datagrams =
        writer_->Write(frames.poses[i], (frames.first_frame + i) / frame_rate_hz_);
    if (!datagrams.ok()) return datagrams.status();
    for (const std::string& datagram : *datagrams) {
      absl::Status status = sender_.Send(datagram);
      if (!status.ok()) return status;
    }
    ++frame_count_;
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<std::string>> VmcSink::Finish(const LiveInfo& /*info*/) {
  return std::vector<std::string>{absl::StrCat(name_, " (", frame_count_, " frames)")};
}

}  // namespace duet::client::live
