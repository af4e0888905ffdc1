#ifndef DUET_CLIENT_LIVE_VMC_SINK_H_
#define DUET_CLIENT_LIVE_VMC_SINK_H_

#include <memory>
#include <string>
#include <vector>

#include "client/capture/capture_address.h"
#include "client/capture/udp_socket.h"
#include "client/capture/vmc_writer.h"
#include "client/live/follower_sink.h"

namespace duet::client::live {

// Sends the follower's final frames as VMC (capture/vmc_writer.h), as they come. A receiver that is
// not there yet misses frames; the session goes on.
class VmcSink final : public FollowerSink {
 public:
  // INVALID_ARGUMENT for another protocol, or an address without a host.
  static absl::Status Check(const capture::CaptureAddress& address);
  // Errors: those of Check; INVALID_ARGUMENT for a host that cannot be resolved.
  static absl::StatusOr<std::unique_ptr<VmcSink>> Create(const capture::CaptureAddress& address);

  absl::Status Start(const LeaderFormat& format) override;
  absl::Status Accept(const LiveFrames& frames) override;
  absl::StatusOr<std::vector<std::string>> Finish(const LiveInfo& info) override;

 private:
  VmcSink(std::string name, capture::UdpSender sender)
      : name_(std::move(name)), sender_(std::move(sender)) {}

  const std::string name_;
  capture::UdpSender sender_;
  double frame_rate_hz_ = 0;
  std::unique_ptr<capture::VmcWriter> writer_;
  int frame_count_ = 0;
};

}  // namespace duet::client::live

#endif  // DUET_CLIENT_LIVE_VMC_SINK_H_
