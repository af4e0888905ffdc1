#ifndef DUET_CLIENT_CAPTURE_XSENS_READER_H_
#define DUET_CLIENT_CAPTURE_XSENS_READER_H_

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/capture/stream_reader.h"

namespace duet::client::capture {

// Reads the network stream of Xsens MVN: message MXTP02 (position and orientation as quaternion),
// big-endian. The positions of the 23 segments are their joints, in the world, z up.
//
// The first character that arrives is the leader; others are ignored. A sample may span datagrams.
// Props and fingers are ignored.
//
// Source: MVN's real-time network streaming protocol specification.
class XsensReader : public StreamReader {
 public:
  static constexpr std::size_t kSegments = 23;

  XsensReader();

  const std::vector<std::string>& joint_names() const override { return names_; }
  absl::Status Read(absl::string_view datagram, std::vector<CaptureFrame>* frames) override;
  std::vector<std::string> TakeNotes() override;
  std::string Missing() const override;

 private:
  struct Header {
    uint32_t sample = 0;
    uint8_t items = 0;
    uint32_t time_code_ms = 0;
    uint8_t character = 0;
  };

  bool IsLeader(uint8_t character);
  void Begin(const Header& header);
  absl::Status ReadSegments(absl::string_view items, uint8_t count);
  CaptureFrame MakeFrame();

  std::vector<std::string> names_;
  std::optional<uint8_t> character_;
  bool others_ = false;  // reported
  std::optional<uint32_t> sample_;
  uint32_t time_code_ms_ = 0;
  std::optional<uint32_t> last_sample_, last_time_code_ms_;  // of the last complete sample
  std::bitset<kSegments> arrived_;
  std::vector<motion::Vec3> positions_;
  std::vector<std::string> notes_;
};

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_XSENS_READER_H_
