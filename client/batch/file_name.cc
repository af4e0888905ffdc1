#include "client/batch/file_name.h"

#include <cstddef>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "model/base/sha256.h"

namespace duet::client::batch {
namespace {

// File systems allow 255 bytes; extensions and the names of temporary files need the rest.
constexpr std::size_t kMaxPartBytes = 200;
// Linux opens paths of up to 4095 bytes; the data set's folder needs the rest.
constexpr std::size_t kMaxPathBytes = 1000;
constexpr std::size_t kDigestDigits = 16;
constexpr std::size_t kKeptBytes = 120;

// Bytes of the UTF-8 character at `at`; 0 if the bytes there are not valid UTF-8.
std::size_t CharacterBytes(const std::string& text, std::size_t at) {
  const auto byte = [&text](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const auto follows = [&byte](std::size_t i) { return (byte(i) & 0xc0u) == 0x80u; };
  const unsigned first = byte(at), second = byte(at + 1);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return follows(at + 1) ? 2 : 0;
  if (first >= 0xe0 && first <= 0xef) {
    // Rejects overlong encodings and UTF-16 surrogates.
    const bool allowed = (first != 0xe0 || second >= 0xa0) && (first != 0xed || second < 0xa0);
    return allowed && follows(at + 1) && follows(at + 2) ? 3 : 0;
  }
  if (first >= 0xf0 && first <= 0xf4) {
    const bool allowed = (first != 0xf0 || second >= 0x90) && (first != 0xf4 || second < 0x90);
    return allowed && follows(at + 1) && follows(at + 2) && follows(at + 3) ? 4 : 0;
  }
  return 0;
}

// At most the first `bytes` bytes, without truncating a character.
std::string Beginning(const std::string& text, std::size_t bytes) {
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xc0u) == 0x80u) --bytes;
  return text.substr(0, bytes);
}

std::string Shortened(const std::string& text, const std::string& of) {
  return absl::StrCat(Beginning(text, kKeptBytes), "_",
                      base::Sha256Hex(of).substr(0, kDigestDigits));
}

}  // namespace

std::string FitFileName(const std::string& name) {
  std::vector<std::string> parts = absl::StrSplit(name, '/');
  for (std::string& part : parts) {
    if (part.size() > kMaxPartBytes) part = Shortened(part, part);
  }
  std::string fitting = absl::StrJoin(parts, "/");
  if (fitting.size() <= kMaxPathBytes) return fitting;
  return Shortened(absl::StrReplaceAll(name, {{"/", "_"}}), name);
}

std::string AsUtf8(const std::string& text) {
  std::string valid;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t bytes = CharacterBytes(text, at);
    valid += bytes == 0 ? "_" : text.substr(at, bytes);
    at += bytes == 0 ? 1 : bytes;
  }
  return valid;
}

}  // namespace duet::client::batch
