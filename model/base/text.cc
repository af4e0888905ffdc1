#include "model/base/text.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"

namespace duet::base {
namespace {

constexpr int kMaxInteger = 999'999'999;  // differences of two still fit

// Messages may contain names from the file. They must still be one printable line.
constexpr std::size_t kLongestError = 1000;

// Handwritten files may have a '+', which from_chars rejects.
absl::string_view StripPlus(absl::string_view text) {
  text = absl::StripAsciiWhitespace(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

template <typename Number>
bool ParseWhole(absl::string_view text, Number* value) {
  text = StripPlus(text);
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, *value);
  return error == std::errc() && stop == end && !text.empty();
}

template <typename Number>
void AppendShortest(std::string* out, Number value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  out->append(buffer, result.ptr);
}

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

bool ParseNumber(absl::string_view text, double* value) {
  return ParseWhole(text, value) && std::isfinite(*value);
}

bool ParseInteger(absl::string_view text, int* value) {
  return ParseWhole(text, value) && std::abs(static_cast<double>(*value)) <= kMaxInteger;
}

void AppendNumber(std::string* out, float value) { AppendShortest(out, value); }
void AppendNumber(std::string* out, double value) { AppendShortest(out, value); }

std::string NumberText(float value) {
  std::string text;
  AppendNumber(&text, value);
  return text;
}

std::string NumberText(double value) {
  std::string text;
  AppendNumber(&text, value);
  return text;
}

void AppendFixed(std::string* out, double value, int decimals) {
  char buffer[512];  // the largest double has 309 digits before the point
  const auto result =
      std::to_chars(buffer, buffer + sizeof(buffer), value, std::chars_format::fixed, decimals);
  absl::string_view text(buffer, static_cast<std::size_t>(result.ptr - buffer));
  const bool zero = text.find_first_not_of("-0.") == absl::string_view::npos;
  if (zero && text[0] == '-') text.remove_prefix(1);
  out->append(text.data(), text.size());
}

std::string Quoted(absl::string_view text) {
  const bool shortened = text.size() > kLongestQuote;
  std::string escaped = absl::CHexEscape(text.substr(0, kLongestQuote));
  absl::StrReplaceAll({{R"(\')", "'"}}, &escaped);  // needs no escape between double quotes
  return absl::StrCat("\"", escaped, shortened ? "...\"" : "\"");
}

std::string Printable(absl::string_view text, std::size_t longest) {
  std::string line = WithEscapes(text.substr(0, longest),
                                 [](unsigned char byte) { return !absl::ascii_isprint(byte); });
  return text.size() > longest ? line + "..." : line;
}

std::string EscapeControls(absl::string_view text) {
  return WithEscapes(text, [](unsigned char byte) { return absl::ascii_iscntrl(byte); });
}

absl::Status ErrorAt(absl::string_view source, int line, absl::string_view message) {
  return absl::InvalidArgumentError(
      absl::StrCat(source, ":", line, ": ", Printable(message, kLongestError)));
}

absl::Status ErrorAt(absl::string_view source, int line, int column, absl::string_view message) {
  return absl::InvalidArgumentError(
      absl::StrCat(source, ":", line, ":", column, ": ", Printable(message, kLongestError)));
}

absl::string_view SkipByteOrderMark(absl::string_view text) {
  absl::ConsumePrefix(&text, "\xEF\xBB\xBF");
  return text;
}

LineReader::LineReader(absl::string_view text)
    : rest_(text), end_(absl::StrContains(text, '\n') ? '\n' : '\r') {}

bool LineReader::Next(absl::string_view* line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find(end_);
  *line = rest_.substr(0, end);
  rest_.remove_prefix(end == absl::string_view::npos ? rest_.size() : end + 1);
  if (!line->empty() && line->back() == '\r') line->remove_suffix(1);
  ++number_;
  return true;
}

}  // namespace duet::base
