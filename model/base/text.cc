#include "model/base/text.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <ios>
#include <system_error>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace duet::base {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadBlock = std::size_t{1} << 16;
constexpr std::size_t kLongestQuote = 40;
constexpr int kMaxInteger = 999'999'999;  // differences of two still fit

absl::Status CheckReadable(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    return absl::NotFoundError(absl::StrCat(path.string(), ": no such file"));
  }
  if (status.type() == fs::file_type::directory) {
    return absl::InvalidArgumentError(absl::StrCat(path.string(), ": is a folder, wanted a file"));
  }
  return absl::OkStatus();
}

// from_chars takes no '+'; files by hand have it.
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

}  // namespace

absl::StatusOr<std::string> ReadFile(const fs::path& path, std::size_t max_bytes) {
  if (absl::Status status = CheckReadable(path); !status.ok()) return status;
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::PermissionDeniedError(absl::StrCat(path.string(), ": cannot be opened"));
  std::string content;
  std::string block(kReadBlock, '\0');
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())) || file.gcount() > 0) {
    content.append(block, 0, static_cast<std::size_t>(file.gcount()));
    if (content.size() > max_bytes) {
      return absl::InvalidArgumentError(absl::StrCat(path.string(), ": larger than ",
                                                     max_bytes >> 20,
                                                     " MiB, wanted a motion of at "
                                                     "most ",
                                                     kMaxMotionFrames, " frames"));
    }
  }
  if (file.bad()) return absl::DataLossError(absl::StrCat(path.string(), ": cannot be read"));
  return content;
}

absl::Status WriteFile(const fs::path& path, absl::string_view content) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    return absl::InvalidArgumentError(absl::StrCat(path.string(), ": is a folder, wanted a file"));
  }
  // A pipe or a device cannot be replaced, only written to.
  const bool special = fs::exists(path, error) && !fs::is_regular_file(path, error);
  const fs::path target = special ? path : fs::path(path.string() + ".partial");
  std::ofstream file(target, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) {
    if (!special) fs::remove(target, error);
    return absl::PermissionDeniedError(absl::StrCat(path.string(), ": cannot be written"));
  }
  if (!special) fs::rename(target, path, error);
  if (error) {
    return absl::PermissionDeniedError(
        absl::StrCat(path.string(), ": cannot be written: ", error.message()));
  }
  return absl::OkStatus();
}

bool ParseNumber(absl::string_view text, double* value) {
  return ParseWhole(text, value) && std::isfinite(*value);
}

bool ParseCoordinate(absl::string_view text, float* value) {
  double number = 0;
  if (!ParseNumber(text, &number) || std::abs(number) > kMaxCoordinate) return false;
  *value = static_cast<float>(number);
  return true;
}

bool ParseInteger(absl::string_view text, int* value) {
  return ParseWhole(text, value) && std::abs(static_cast<double>(*value)) <= kMaxInteger;
}

void AppendNumber(std::string* out, float value) { AppendShortest(out, value); }
void AppendNumber(std::string* out, double value) { AppendShortest(out, value); }

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
  return absl::StrCat("\"", absl::CHexEscape(text.substr(0, kLongestQuote)),
                      shortened ? "...\"" : "\"");
}

absl::Status ErrorAt(absl::string_view source, int line, absl::string_view message) {
  return absl::InvalidArgumentError(absl::StrCat(source, ":", line, ": ", message));
}

absl::Status ErrorAt(absl::string_view source, int line, int column, absl::string_view message) {
  return absl::InvalidArgumentError(absl::StrCat(source, ":", line, ":", column, ": ", message));
}

absl::Status CheckFrameRate(absl::string_view source, double frame_rate_hz) {
  if (frame_rate_hz > 0 && frame_rate_hz <= kMaxFrameRateHz) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(source, ": frame rate: came ", frame_rate_hz,
                                                 ", wanted more than 0 and at most ",
                                                 kMaxFrameRateHz, " Hz"));
}

bool LineReader::Next(absl::string_view* line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  *line = rest_.substr(0, end);
  rest_.remove_prefix(end == absl::string_view::npos ? rest_.size() : end + 1);
  if (!line->empty() && line->back() == '\r') line->remove_suffix(1);
  ++number_;
  return true;
}

}  // namespace duet::base
