#include "tests/client/capture/datagrams.h"

#include <cstddef>
#include <cstring>

#include "absl/strings/str_cat.h"

namespace duet::test {
namespace {

std::string Big32(uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16 & 0xff),
          static_cast<char>(value >> 8 & 0xff), static_cast<char>(value & 0xff)};
}

std::string Big16(unsigned value) {
  return {static_cast<char>(value >> 8 & 0xff), static_cast<char>(value & 0xff)};
}

std::string BigFloat(float value) {
  uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return Big32(bits);
}

std::string OscText(const std::string& text) {
  std::string padded = text;
  do padded.push_back('\0');
  while (padded.size() % 4 != 0);
  return padded;
}

std::string Element(const std::string& message) {
  return Big32(static_cast<uint32_t>(message.size())) + message;
}

}  // namespace

std::string VmcDatagram(const VmcFrame& frame) {
  std::string bundle = OscText("#bundle") + Big32(0) + Big32(1);
  if (frame.seconds.has_value()) {
    bundle += Element(OscText("/VMC/Ext/T") + OscText(",f") + BigFloat(*frame.seconds));
  }
  for (const VmcBone& bone : frame.bones) {
    std::string message = OscText("/VMC/Ext/Bone/Pos") + OscText(",sfffffff") + OscText(bone.name);
    for (const float value : bone.position) message += BigFloat(value);
    for (const float value : bone.rotation) message += BigFloat(value);
    bundle += Element(message);
  }
  return bundle;
}

std::string XsensDatagram(const XsensFrame& frame) {
  std::string bytes = frame.id + Big32(frame.sample);
  bytes.push_back(static_cast<char>(frame.datagram));
  bytes.push_back(static_cast<char>(frame.positions.size()));
  bytes += Big32(frame.time_code_ms);
  bytes.push_back(static_cast<char>(frame.character));
  bytes += std::string("\x17\0\0", 3);
  bytes += Big16(0) + Big16(static_cast<unsigned>(frame.positions.size() * 32));
  uint32_t segment = frame.first_segment;
  for (const motion::Vec3& position : frame.positions) {
    bytes += Big32(segment++) + BigFloat(position.x) + BigFloat(position.y) + BigFloat(position.z);
    bytes += BigFloat(1) + BigFloat(0) + BigFloat(0) + BigFloat(0);
  }
  return bytes;
}

std::string RokokoJson(double timestamp, const std::string& actor,
                       const std::vector<std::string>& joints,
                       absl::Span<const motion::Vec3> positions) {
  std::string body;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    absl::StrAppend(&body, i == 0 ? "" : ",", "\"", joints[i],
                    "\":{\"position\":{\"x\":", positions[i].x, ",\"y\":", positions[i].y,
                    ",\"z\":", positions[i].z, "},\"rotation\":{\"x\":0,\"y\":0,\"z\":0,\"w\":1}}");
  }
  return absl::StrCat(R"({"version":"3,0","fps":60,"scene":{"timestamp":)", timestamp,
                      R"(,"actors":[{"name":")", actor,
                      R"(","meta":{"hasGloves":false,"hasBody":true,"hasFace":false},"body":{)",
                      body, R"(}}],"props":[]}})");
}

std::string StoredLz4Frame(const std::string& content) {
  std::string bytes("\x04\x22\x4d\x18\x60\x70\x73", 7);
  const auto size = static_cast<uint32_t>(content.size());
  for (const int shift : {0, 8, 16}) bytes.push_back(static_cast<char>(size >> shift & 0xff));
  bytes.push_back(static_cast<char>((size >> 24 & 0xff) | 0x80));
  return bytes + content + std::string(4, '\0');
}

}  // namespace duet::test
