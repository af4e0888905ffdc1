#include "model/base/printable.h"

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace duet::base {

std::string Printable(absl::string_view text, std::size_t longest) {
  std::string line;
  for (const char& byte : text.substr(0, longest)) {
    if (absl::ascii_isprint(static_cast<unsigned char>(byte))) {
      line += byte;
    } else {
      absl::StrAppend(&line, absl::CHexEscape({&byte, 1}));
    }
  }
  return text.size() > longest ? line + "..." : line;
}

}  // namespace duet::base
