#ifndef DUET_CLIENT_CAPTURE_STREAM_READER_H_
#define DUET_CLIENT_CAPTURE_STREAM_READER_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "model/motion/vec3.h"

namespace duet::client::capture {

// The longest payload of a UDP datagram over IPv4.
inline constexpr std::size_t kMaxDatagramBytes = 65507;
// Metres. No capture volume is larger; positions beyond it are errors of the sender.
inline constexpr float kMaxCapturePosition = 1000;
// Seconds. Differences of such times are exact to a millisecond.
inline constexpr double kMaxSenderSeconds = 1e12;

// One frame of a capture stream.
//
// Shapes: positions [joint_names]. Units: metres, y up, right-handed.
struct CaptureFrame {
  // When the sender captured it, in seconds on the sender's clock. Absent if the sender does not
  // say, or repeats the time of another frame.
  std::optional<double> sender_seconds;
  std::vector<motion::Vec3> positions;
};

// Reads the datagrams of one capture protocol. A reader keeps the part of a frame that has not
// arrived completely. All readers take arbitrary bytes.
class StreamReader {
 public:
  virtual ~StreamReader() = default;

  // The joints of every frame; known before the first datagram.
  virtual const std::vector<std::string>& joint_names() const = 0;
  // Reads one datagram and appends the frames that it completes, at most kMaxFramesInDatagram.
  // Errors: INVALID_ARGUMENT for a datagram that is malformed or of another protocol. Later
  // datagrams can be read as if it had not arrived.
  virtual absl::Status Read(absl::string_view datagram, std::vector<CaptureFrame>* frames) = 0;
  // What the user should know about the stream, such as bones that the sender leaves out. Each
  // note is returned once.
  virtual std::vector<std::string> TakeNotes() { return {}; }
  // What has arrived, and what would make frames, for a stream that has made none: "VMC: expected
  // ..., got ...". Empty if only errors can tell.
  virtual std::string Missing() const { return ""; }
};

inline constexpr int kMaxFramesInDatagram = 8;

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_STREAM_READER_H_
