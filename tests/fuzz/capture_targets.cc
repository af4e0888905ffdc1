#include "tests/fuzz/capture_targets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "client/capture/capture_address.h"
#include "client/capture/capture_stream.h"
#include "client/capture/stream_reader.h"
#include "model/motion/vec3.h"

namespace duet::fuzz {
namespace {

using client::capture::CaptureFrame;
using client::capture::CaptureProtocol;
using client::capture::CaptureStream;
using client::capture::StreamReader;
using client::capture::TimedFrame;

constexpr double kRateHz = 60;
// Of all bones of a chain, each as far from the last one as a position may be.
constexpr float kFarthest = 32 * client::capture::kMaxCapturePosition;

struct Datagram {
  double seconds = 0;
  std::string sender;
  absl::string_view bytes;
};

std::vector<Datagram> DatagramsOf(absl::string_view input) {
  constexpr std::size_t kHeader = 4;
  const auto byte = [&input](std::size_t i) { return static_cast<unsigned char>(input[i]); };
  std::vector<Datagram> datagrams;
  double seconds = 0;
  while (input.size() >= kHeader) {
    seconds += byte(0) * 1e-3;
    const std::size_t length = byte(2) * std::size_t{256} + byte(3);
    Datagram datagram{seconds, std::string(1, input[1]), {}};
    input.remove_prefix(kHeader);
    datagram.bytes = input.substr(0, length);
    input.remove_prefix(datagram.bytes.size());
    datagrams.push_back(std::move(datagram));
  }
  return datagrams;
}

Broken CheckPositions(const std::vector<motion::Vec3>& positions, std::size_t joints) {
  if (positions.size() != joints) return "a frame has other joints than its stream";
  for (const motion::Vec3& position : positions) {
    // Comparisons are false for NaN.
    if (!(std::abs(position.x) <= kFarthest && std::abs(position.y) <= kFarthest &&
          std::abs(position.z) <= kFarthest)) {
      return "a position is beyond all bounds";
    }
  }
  return "";
}

// The reader by itself: its errors and frames.
Broken CheckReader(CaptureProtocol protocol, const std::vector<Datagram>& datagrams) {
  const std::unique_ptr<StreamReader> reader = MakeStreamReader(protocol);
  for (const Datagram& datagram : datagrams) {
    std::vector<CaptureFrame> frames;
    Broken broken = CheckRefusal(reader->Read(datagram.bytes, &frames));
    if (!broken.empty()) return broken;
    if (frames.size() > std::size_t{client::capture::kMaxFramesInDatagram}) {
      return "a datagram has more frames than promised";
    }
    for (const CaptureFrame& frame : frames) {
      broken = CheckPositions(frame.positions, reader->joint_names().size());
      if (!broken.empty()) return broken;
      if (frame.sender_seconds.has_value() &&
          !(std::abs(*frame.sender_seconds) <= client::capture::kMaxSenderSeconds)) {
        return "a time is beyond all bounds";
      }
    }
    for (const std::string& note : reader->TakeNotes()) {
      broken = CheckRefusal(absl::InvalidArgumentError(note));
      if (!broken.empty()) return broken;
    }
  }
  return "";
}

// The whole way to frames at a fixed rate.
Broken CheckStream(CaptureProtocol protocol, const std::vector<Datagram>& datagrams,
                   double rate_hz) {
  CaptureStream stream([protocol] { return MakeStreamReader(protocol); }, rate_hz);
  int next = 0;
  for (const Datagram& datagram : datagrams) {
    stream.Receive(datagram.bytes, datagram.sender, datagram.seconds);
    while (const std::optional<TimedFrame> frame = stream.Next(datagram.seconds)) {
      if (frame->index != next++) return "a frame was lost or doubled";
      if (!std::isfinite(frame->capture_seconds)) return "a time is not finite";
      Broken broken = CheckPositions(frame->positions, stream.joint_names().size());
      if (!broken.empty()) return broken;
    }
    // The times of a sender, whatever they are, give no more frames than time has passed.
    const double most = (datagram.seconds + 1) * std::max(stream.rate_hz(), 1.0) + 16;
    if (next > most) return absl::StrCat(next, " frames in ", datagram.seconds, " s");
    if (std::isnan(stream.NextDue())) return "nobody knows when the next frame is due";
  }
  return stream.TakeNotes().size() > 64 ? "more notes than promised" : "";
}

Broken CheckAll(CaptureProtocol protocol, absl::string_view input) {
  const std::vector<Datagram> datagrams = DatagramsOf(input);
  Broken broken = CheckReader(protocol, datagrams);
  if (broken.empty()) broken = CheckStream(protocol, datagrams, kRateHz);
  return broken.empty() ? CheckStream(protocol, datagrams, 0) : broken;
}

}  // namespace

Broken Vmc(absl::string_view input) { return CheckAll(CaptureProtocol::kVmc, input); }

Broken Xsens(absl::string_view input) { return CheckAll(CaptureProtocol::kXsens, input); }

Broken Rokoko(absl::string_view input) { return CheckAll(CaptureProtocol::kRokoko, input); }

}  // namespace duet::fuzz
