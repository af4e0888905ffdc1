#include "model/base/printable.h"

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace duet::base {
namespace {

std::string WithEscapes(absl::string_view text, bool (*is_escaped)(unsigned char)) {
  std::string line;
  for (const char& byte : text) {
    if (is_escaped(static_cast<unsigned char>(byte))) {
      absl::StrAppend(&line, absl::CHexEscape({&byte, 1}));
    } else {
      line += byte;
    }
  }
  return line;
}

}  // namespace

std::string Printable(absl::string_view text, std::size_t longest) {
  std::string line = WithEscapes(text.substr(0, longest),
                                 [](unsigned char byte) { return !absl::ascii_isprint(byte); });
  return text.size() > longest ? line + "..." : line;
}

std::string EscapeControls(absl::string_view text) {
  return WithEscapes(text, [](unsigned char byte) { return absl::ascii_iscntrl(byte); });
}

}  // namespace duet::base
