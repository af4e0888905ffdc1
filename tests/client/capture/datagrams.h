#ifndef DUET_TESTS_CLIENT_CAPTURE_DATAGRAMS_H_
#define DUET_TESTS_CLIENT_CAPTURE_DATAGRAMS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/vec3.h"

// Datagrams as the protocols' published layouts have them, written independently of the readers.

namespace duet::test {

// A bone of VMC, in Unity's axes.
struct VmcBone {
  std::string name;
  float position[3] = {};
  float rotation[4] = {0, 0, 0, 1};  // x, y, z, w
};
struct VmcFrame {
  std::optional<float> seconds;
  std::vector<VmcBone> bones;
};
// One bundle with a time, if any, and the bones.
std::string VmcDatagram(const VmcFrame& frame);

struct XsensFrame {
  std::string id = "MXTP02";
  uint32_t sample = 0;
  uint8_t datagram = 0x80;
  uint32_t time_code_ms = 0;
  uint8_t character = 0;
  uint32_t first_segment = 1;
  std::vector<motion::Vec3> positions;  // z up
};
std::string XsensDatagram(const XsensFrame& frame);

// JSON v3 with one actor. positions: of `joints`, in Unity's axes.
std::string RokokoJson(double timestamp, const std::string& actor,
                       const std::vector<std::string>& joints,
                       absl::Span<const motion::Vec3> positions);

// An LZ4 frame of stored blocks.
std::string StoredLz4Frame(const std::string& content);

}  // namespace duet::test

#endif  // DUET_TESTS_CLIENT_CAPTURE_DATAGRAMS_H_
