#include "model/evaluation/report/markup.h"

#include <cstddef>
#include <cstring>

#include "absl/strings/ascii.h"

namespace duet::evaluation::report {
namespace {

bool IsWord(const std::string& text, std::size_t at) {
  return at < text.size() && absl::ascii_isalnum(static_cast<unsigned char>(text[at]));
}

}  // namespace

std::string EscapeMarkdown(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    // Within a word, an underscore is just that; elsewhere it would start or end emphasis.
    const bool is_plain_underscore =
        c == '_' && i > 0 && IsWord(text, i - 1) && IsWord(text, i + 1);
    if (std::strchr("\\|*_`[]<>~#", c) != nullptr && c != '\0' && !is_plain_underscore) out += '\\';
    out += absl::ascii_iscntrl(static_cast<unsigned char>(c)) ? ' ' : c;
  }
  return out;
}

std::string EscapeMarkup(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&#39;";
    } else if (!absl::ascii_iscntrl(static_cast<unsigned char>(c))) {
      out += c;
    }
  }
  return out;
}

std::string EscapeCsv(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

}  // namespace duet::evaluation::report
