#include "client/capture/osc.h"

#include <cstdint>
#include <cstring>
#include <limits>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/capture/byte_reader.h"
#include "model/base/text.h"

namespace duet::client::capture {
namespace {

constexpr absl::string_view kBundle("#bundle\0", 8);
constexpr std::size_t kTimeTagBytes = 8;

// OSC pads everything to a multiple of 4 bytes.
std::size_t Padded(std::size_t size) { return (size + 3) / 4 * 4; }

// A text that ends with a NUL byte, and its padding.
bool ReadText(ByteReader* reader, absl::string_view* text) {
  const std::size_t end = reader->rest().find('\0');
  if (end == absl::string_view::npos) return false;
  *text = reader->rest().substr(0, end);
  reader->Bytes(Padded(end + 1));
  return reader->ok();
}

absl::Status VisitMessage(absl::string_view bytes,
                          absl::FunctionRef<absl::Status(const OscMessage&)> visit) {
  ByteReader reader(bytes);
  OscMessage message;
  absl::string_view types;
  if (!ReadText(&reader, &message.address) || !absl::StartsWith(message.address, "/")) {
    return absl::InvalidArgumentError(
        absl::StrCat("OSC address: expected a padded text that begins with '/', got ",
                     base::Quoted(bytes.substr(0, base::kLongestQuote))));
  }
  if (!ReadText(&reader, &types) || !absl::StartsWith(types, ",")) {
    return absl::InvalidArgumentError(
        absl::StrCat("OSC types of ", base::Quoted(message.address),
                     ": expected a padded text that begins with ',', got none"));
  }
  message.types = types.substr(1);
  message.data = reader.rest();
  return visit(message);
}

absl::Status VisitPacket(absl::string_view bytes, int depth,
                         absl::FunctionRef<absl::Status(const OscMessage&)> visit) {
  if (!absl::StartsWith(bytes, kBundle)) return VisitMessage(bytes, visit);
  if (depth >= kMaxOscDepth) {
    return absl::InvalidArgumentError(absl::StrCat("OSC bundle: expected at most ", kMaxOscDepth,
                                                   " levels of bundles, got more"));
  }
  ByteReader reader(bytes.substr(kBundle.size()));
  reader.Bytes(kTimeTagBytes);
  while (reader.ok() && !reader.rest().empty()) {
    const uint32_t size = reader.Big32();
    const absl::string_view element = reader.Bytes(size);
    if (!reader.ok() || element.empty()) break;
    absl::Status status = VisitPacket(element, depth + 1, visit);
    if (!status.ok()) return status;
  }
  if (reader.ok() && reader.rest().empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "OSC bundle: expected a time and elements of the sizes that they state, got fewer bytes");
}

// Reads the argument of the type `type`. False for other types.
bool ReadArgument(char type, ByteReader* reader, OscArgument* argument) {
  switch (type) {
    case 'i':
      argument->number = static_cast<int32_t>(reader->Big32());
      return true;
    case 'h':
      argument->number = static_cast<double>(static_cast<int64_t>(reader->Big64()));
      return true;
    case 'f':
      argument->number = static_cast<double>(reader->BigFloat());
      return true;
    case 'd':
      argument->number = reader->BigDouble();
      return true;
    case 'T':
    case 'F':
      argument->number = type == 'T' ? 1 : 0;
      return true;
    case 's':
      argument->is_text = true;
      return ReadText(reader, &argument->text);
    default:
      return false;
  }
}

}  // namespace

absl::Status ForEachOscMessage(absl::string_view datagram,
                               absl::FunctionRef<absl::Status(const OscMessage&)> visit) {
  return VisitPacket(datagram, 0, visit);
}

absl::StatusOr<std::vector<OscArgument>> ReadOscArguments(const OscMessage& message) {
  if (message.types.size() > kMaxOscArguments) {
    return absl::InvalidArgumentError(absl::StrCat(base::Quoted(message.address),
                                                   ": expected at most ", kMaxOscArguments,
                                                   " arguments, got ", message.types.size()));
  }
  ByteReader reader(message.data);
  std::vector<OscArgument> arguments;
  for (const char type : message.types) {
    OscArgument argument;
    if (!ReadArgument(type, &reader, &argument) || !reader.ok()) {
      return absl::InvalidArgumentError(
          absl::StrCat(base::Quoted(message.address), ": expected arguments of the types ",
                       base::Quoted(message.types), ", got ", message.data.size(), " bytes"));
    }
    arguments.push_back(argument);
  }
  return arguments;
}

OscBundle::OscBundle() : bytes_(kBundle) {
  AddBig32(0);
  AddBig32(1);  // the time tag that means "immediately"
}

void OscBundle::Begin(absl::string_view address, absl::string_view types) {
  EndMessage();
  message_ = bytes_.size();
  AddBig32(0);
  AddText(address);
  AddText(absl::StrCat(",", types));
}

void OscBundle::Add(int value) { AddBig32(static_cast<unsigned>(value)); }

void OscBundle::Add(float value) {
  uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  AddBig32(bits);
}

void OscBundle::Add(absl::string_view text) { AddText(text); }

bool OscBundle::empty() const { return bytes_.size() <= kBundle.size() + kTimeTagBytes; }

const std::string& OscBundle::bytes() {
  EndMessage();
  return bytes_;
}

void OscBundle::EndMessage() {
  if (message_ == 0) return;
  const auto size = static_cast<uint32_t>(bytes_.size() - message_ - sizeof(uint32_t));
  for (std::size_t i = 0; i < sizeof(size); ++i) {
    bytes_[message_ + i] = static_cast<char>((size >> (24 - 8 * i)) & 0xff);
  }
  message_ = 0;
}

void OscBundle::AddText(absl::string_view text) {
  absl::StrAppend(&bytes_, text);
  bytes_.append(Padded(text.size() + 1) - text.size(), '\0');
}

void OscBundle::AddBig32(unsigned value) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes_.push_back(static_cast<char>((value >> shift) & 0xff));
  }
}

}  // namespace duet::client::capture
