#include "client/capture/xsens_reader.h"

#include <cmath>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/capture/byte_reader.h"
#include "model/base/text.h"
#include "model/motion/coordinates.h"

namespace duet::client::capture {
namespace {

constexpr absl::string_view kHeader = "MXTP";
constexpr absl::string_view kPoseQuaternion = "MXTP02";
constexpr std::size_t kIdBytes = 6, kItemBytes = 32;
constexpr double kSecondsPerMillisecond = 1e-3;

}  // namespace

// The spine's segments are named so that the joints of a model are found by name
// (retargeting/joint_names.h).
XsensReader::XsensReader()
    : names_({"Pelvis",        "SpineL5",       "SpineL3",       "SpineT12",      "SpineT8",
              "Neck",          "Head",          "RightShoulder", "RightUpperArm", "RightForeArm",
              "RightHand",     "LeftShoulder",  "LeftUpperArm",  "LeftForeArm",   "LeftHand",
              "RightUpperLeg", "RightLowerLeg", "RightFoot",     "RightToe",      "LeftUpperLeg",
              "LeftLowerLeg",  "LeftFoot",      "LeftToe"}),
      positions_(kSegments) {}

absl::Status XsensReader::Read(absl::string_view datagram, std::vector<CaptureFrame>* frames) {
  if (!absl::StartsWith(datagram, kHeader)) {
    return absl::InvalidArgumentError(absl::StrCat("Xsens: expected a datagram that begins with ",
                                                   kPoseQuaternion, ", got ",
                                                   base::Quoted(datagram.substr(0, kIdBytes))));
  }
  ByteReader reader(datagram);
  const absl::string_view id = reader.Bytes(kIdBytes);
  if (id != kPoseQuaternion) {
    return absl::InvalidArgumentError(
        absl::StrCat("Xsens: expected ", kPoseQuaternion, ", got ", base::Quoted(id),
                     "; in MVN's network streamer, select Position + Orientation (Quaternion)"));
  }
  Header header;
  header.sample = reader.Big32();
  reader.Byte();  // the datagram's number within the sample: segments have numbers of their own
  header.items = reader.Byte();
  header.time_code_ms = reader.Big32();
  header.character = reader.Byte();
  reader.Byte();  // numbers of body segments, props and finger segments
  reader.Byte();
  reader.Byte();
  reader.Big16();  // reserved
  reader.Big16();  // payload bytes: the datagram's own length is more reliable
  if (!reader.ok() || reader.rest().size() < kItemBytes * header.items) {
    return absl::InvalidArgumentError(absl::StrCat("Xsens: expected a header and ", header.items,
                                                   " segments of ", kItemBytes, " bytes, got ",
                                                   datagram.size(), " bytes"));
  }
  if (!IsLeader(header.character)) return absl::OkStatus();
  if (sample_ != header.sample) Begin(header);
  absl::Status status = ReadSegments(reader.rest(), header.items);
  if (status.ok() && arrived_.all()) frames->push_back(MakeFrame());
  return status;
}

std::string XsensReader::Missing() const {
  return absl::StrCat("Xsens: expected the ", kSegments, " segments of a body, got ",
                      arrived_.count());
}

std::vector<std::string> XsensReader::TakeNotes() { return std::exchange(notes_, {}); }

bool XsensReader::IsLeader(uint8_t character) {
  if (!character_.has_value()) character_ = character;
  if (character_ == character) return true;
  if (!std::exchange(others_, true)) {
    notes_.push_back(absl::StrCat("Xsens: character ", *character_,
                                  " leads; the other characters of the stream are ignored"));
  }
  return false;
}

void XsensReader::Begin(const Header& header) {
  sample_ = header.sample;
  time_code_ms_ = header.time_code_ms;
  arrived_.reset();
}

absl::Status XsensReader::ReadSegments(absl::string_view items, uint8_t count) {
  static constexpr motion::Coordinates kZUp{motion::LengthUnit::kMetres, motion::UpAxis::kZUp};
  ByteReader reader(items);
  for (int item = 0; item < count; ++item) {
    const uint32_t segment = reader.Big32();
    motion::Vec3 position;
    for (float* value : {&position.x, &position.y, &position.z}) *value = reader.BigFloat();
    reader.Bytes(4 * sizeof(float));  // the quaternion
    if (segment < 1 || segment > kSegments) continue;
    for (const float value : {position.x, position.y, position.z}) {
      if (std::abs(value) <= kMaxCapturePosition) continue;
      return absl::InvalidArgumentError(absl::StrCat("Xsens: segment ", segment,
                                                     ": expected a position within ",
                                                     kMaxCapturePosition, " m, got ", value));
    }
    positions_[segment - 1] = ToWorld(kZUp, position);
    arrived_[segment - 1] = true;
  }
  return absl::OkStatus();
}

CaptureFrame XsensReader::MakeFrame() {
  arrived_.reset();
  CaptureFrame frame;
  frame.positions = positions_;
  // A time code that stands still while samples go on is no time.
  const bool stands_still = last_time_code_ms_ == time_code_ms_ && last_sample_ != sample_;
  if (!stands_still) frame.sender_seconds = time_code_ms_ * kSecondsPerMillisecond;
  last_time_code_ms_ = time_code_ms_;
  last_sample_ = sample_;
  return frame;
}

}  // namespace duet::client::capture
