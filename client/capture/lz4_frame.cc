#include "client/capture/lz4_frame.h"

#include <cstdint>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/capture/byte_reader.h"

namespace duet::client::capture {
namespace {

constexpr absl::string_view kMagic("\x04\x22\x4d\x18", 4);
// Bits of the frame's descriptor.
constexpr unsigned kVersionMask = 0xc0, kVersion = 0x40, kBlockChecksum = 0x10, kContentSize = 0x08,
                   kDictionary = 0x01;
constexpr uint32_t kStoredBlock = 0x80000000u;
constexpr std::size_t kChecksumBytes = 4, kContentSizeBytes = 8;
// Of a block: a length of 15 is continued by further bytes; matches have at least 4 bytes.
constexpr std::size_t kContinued = 15, kShortestMatch = 4;

absl::Status Malformed(absl::string_view what) {
  return absl::InvalidArgumentError(absl::StrCat("LZ4: expected ", what));
}

// Adds the further bytes of a length.
void ContinueLength(ByteReader* reader, std::size_t* length) {
  for (uint8_t byte = 255; byte == 255 && reader->ok();) {
    byte = reader->Byte();
    *length += byte;
  }
}

// Appends a decompressed block. Matches may reach into earlier blocks.
absl::Status AppendBlock(absl::string_view block, std::size_t max_bytes, std::string* out) {
  ByteReader reader(block);
  while (!reader.rest().empty()) {
    const unsigned token = reader.Byte();
    std::size_t literals = token >> 4;
    if (literals == kContinued) ContinueLength(&reader, &literals);
    const absl::string_view text = reader.Bytes(literals);
    if (!reader.ok()) return Malformed("as many literals as a block states, got fewer bytes");
    if (text.size() > max_bytes - out->size()) break;
    absl::StrAppend(out, text);
    if (reader.rest().empty()) return absl::OkStatus();
    const std::size_t distance = reader.Little16();
    std::size_t length = token & 0xf;
    if (length == kContinued) ContinueLength(&reader, &length);
    length += kShortestMatch;
    if (!reader.ok() || distance == 0 || distance > out->size()) {
      return Malformed("matches within the content, got one before its start");
    }
    if (length > max_bytes - out->size()) break;
    // A match may overlap with what it appends.
    for (std::size_t i = 0; i < length; ++i) out->push_back((*out)[out->size() - distance]);
  }
  if (reader.rest().empty() && reader.ok() && block.empty()) return absl::OkStatus();
  return Malformed(absl::StrCat("blocks that end with literals and a content of at most ",
                                max_bytes, " bytes, got others"));
}

}  // namespace

bool IsLz4Frame(absl::string_view bytes) { return absl::StartsWith(bytes, kMagic); }

absl::StatusOr<std::string> DecompressLz4Frame(absl::string_view bytes, std::size_t max_bytes) {
  if (!IsLz4Frame(bytes)) return Malformed("a frame, got other bytes");
  ByteReader reader(bytes.substr(kMagic.size()));
  const unsigned flags = reader.Byte();
  reader.Byte();  // the maximum size of blocks: `max_bytes` limits all of them
  if ((flags & kVersionMask) != kVersion || (flags & kDictionary) != 0) {
    return Malformed("frame format 1 without a dictionary, got another frame");
  }
  if ((flags & kContentSize) != 0) reader.Bytes(kContentSizeBytes);
  reader.Byte();  // checksum of the header
  std::string out;
  while (true) {
    const uint32_t size = reader.Little32();
    if (!reader.ok()) return Malformed("an end mark, got fewer bytes");
    if (size == 0) return out;
    const absl::string_view block = reader.Bytes(size & ~kStoredBlock);
    if ((flags & kBlockChecksum) != 0) reader.Bytes(kChecksumBytes);
    if (!reader.ok()) return Malformed("blocks of the sizes that they state, got fewer bytes");
    if ((size & kStoredBlock) != 0) {
      if (block.size() > max_bytes - out.size()) {
        return Malformed(absl::StrCat("a content of at most ", max_bytes, " bytes, got more"));
      }
      absl::StrAppend(&out, block);
      continue;
    }
    const absl::Status status = AppendBlock(block, max_bytes, &out);
    if (!status.ok()) return status;
  }
}

}  // namespace duet::client::capture
