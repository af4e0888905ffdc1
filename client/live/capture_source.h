#ifndef DUET_CLIENT_LIVE_CAPTURE_SOURCE_H_
#define DUET_CLIENT_LIVE_CAPTURE_SOURCE_H_

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/time/time.h"
#include "client/capture/capture_address.h"
#include "client/capture/capture_stream.h"
#include "client/capture/udp_socket.h"
#include "client/live/leader_source.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"

namespace duet::client::live {

// How a capture protocol is received.
struct CaptureOptions {
  capture::CaptureAddress address;
  double frame_rate_hz = 0;   // of the leader; 0: the sender's, measured for a second
  motion::Skeleton skeleton;  // the model's
  retargeting::JointOverrides joints;
  // Receives what happens while it happens: that frames are waited for, gaps, duplicates. Called by
  // the thread that calls Open and Next. Optional.
  std::function<void(const std::string&)> on_note;
};

// A leader who is captured at this moment: VMC, Xsens MVN or Rokoko over UDP. The leader does not
// end until Stop is called.
class CaptureSource final : public LeaderSource {
 public:
  // Binds the port, so that a port that is in use is reported before a session begins.
  static absl::StatusOr<std::unique_ptr<CaptureSource>> Create(CaptureOptions options);

  int port() const { return receiver_->port(); }

  // Returns when the frame rate is known and the joints of the first frame are mapped.
  absl::StatusOr<LeaderFormat> Open() override;
  absl::StatusOr<std::optional<LeaderEvent>> Next() override;
  void Stop() override { receiver_->Stop(); }
  std::vector<std::string> Notes() const override;

 private:
  CaptureSource(CaptureOptions options, std::unique_ptr<capture::UdpReceiver> receiver);

  absl::StatusOr<std::optional<capture::TimedFrame>> NextFrame();
  void ReportNotes();

  const CaptureOptions options_;
  const std::unique_ptr<capture::UdpReceiver> receiver_;
  capture::CaptureStream stream_;
  std::optional<capture::TimedFrame> first_;  // read by Open, returned by Next
  std::optional<retargeting::JointMap> map_;
};

}  // namespace duet::client::live

#endif  // DUET_CLIENT_LIVE_CAPTURE_SOURCE_H_
