#ifndef DUET_CLIENT_CLI_STYLE_H_
#define DUET_CLIENT_CLI_STYLE_H_

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"

namespace duet::client::cli {

// Colour for people who read a terminal; nothing otherwise.
class Style {
 public:
  explicit Style(bool coloured) : coloured_(coloured) {}

  std::string Heading(absl::string_view text) const { return In("1", text); }
  std::string Good(absl::string_view text) const { return In("32", text); }
  std::string Warning(absl::string_view text) const { return In("33", text); }
  std::string Bad(absl::string_view text) const { return In("1;31", text); }
  std::string Faint(absl::string_view text) const { return In("2", text); }

 private:
  std::string In(const char* code, absl::string_view text) const {
    if (!coloured_ || text.empty()) return std::string(text);
    return absl::StrCat("\x1b[", code, "m", text, "\x1b[0m");
  }

  bool coloured_;
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_STYLE_H_
