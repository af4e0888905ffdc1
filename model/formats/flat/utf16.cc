#include "model/formats/flat/utf16.h"

#include <cstddef>
#include <cstdint>

#include "absl/strings/match.h"

namespace duet::formats::flat {
namespace {

constexpr std::uint32_t kHighFirst = 0xD800, kLowFirst = 0xDC00, kLowLast = 0xDFFF;
constexpr std::uint32_t kInvalid = 0xFFFD;

void AppendUtf8(std::uint32_t c, std::string* out) {
  if (c < 0x80) {
    out->push_back(static_cast<char>(c));
    return;
  }
  const int continuations = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
  const std::uint32_t mark = continuations == 1 ? 0xC0 : continuations == 2 ? 0xE0 : 0xF0;
  out->push_back(static_cast<char>(mark | c >> 6 * continuations));
  for (int i = continuations; i-- > 0;) {
    out->push_back(static_cast<char>(0x80 | (c >> 6 * i & 0x3F)));
  }
}

}  // namespace

std::optional<std::string> FromUtf16(absl::string_view bytes) {
  const bool little = absl::StartsWith(bytes, "\xFF\xFE");
  if (!little && !absl::StartsWith(bytes, "\xFE\xFF")) return std::nullopt;
  const auto unit = [&](std::size_t at) -> std::uint32_t {
    const auto first = static_cast<std::uint8_t>(bytes[at]);
    const auto second = static_cast<std::uint8_t>(bytes[at + 1]);
    return static_cast<std::uint32_t>(little ? second << 8 | first : first << 8 | second);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t at = 2; at + 1 < bytes.size(); at += 2) {
    std::uint32_t c = unit(at);
    if (c >= kHighFirst && c <= kLowLast) {
      const std::uint32_t low = c < kLowFirst && at + 3 < bytes.size() ? unit(at + 2) : 0;
      const bool pair = low >= kLowFirst && low <= kLowLast;
      c = pair ? 0x10000 + ((c - kHighFirst) << 10) + (low - kLowFirst) : kInvalid;
      at += pair ? 2 : 0;
    }
    AppendUtf8(c, &text);
  }
  return text;
}

}  // namespace duet::formats::flat
