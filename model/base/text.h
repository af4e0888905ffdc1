#ifndef DUET_MODEL_BASE_TEXT_H_
#define DUET_MODEL_BASE_TEXT_H_

#include <cstddef>
#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

// What every reader and writer of this folder shares: files as strings, strict numbers that do not
// depend on the locale, and errors that point at a place in a file.

namespace duet::base {

// Above every motion that the service accepts (10 minutes at 240 Hz), so that a wrong file is
// refused before it fills the memory.
inline constexpr std::size_t kMaxMotionFileBytes = std::size_t{512} << 20;
inline constexpr int kMaxMotionFrames = 200'000;
inline constexpr int kMaxFileJoints = 1024;
inline constexpr double kMaxFrameRateHz = 1000;
// Far beyond any capture in any unit, and small enough for exact arithmetic in float.
inline constexpr double kMaxCoordinate = 1e7;

// Errors: NOT_FOUND, PERMISSION_DENIED or INVALID_ARGUMENT (a folder, too large), naming the path.
absl::StatusOr<std::string> ReadFile(const std::filesystem::path& path,
                                     std::size_t max_bytes = kMaxMotionFileBytes);
// Replaces the file as a whole; a failed write leaves no partial file.
absl::Status WriteFile(const std::filesystem::path& path, absl::string_view content);

// The whole of `text` as one finite number; false otherwise. A leading '+' and surrounding blanks
// are allowed.
bool ParseNumber(absl::string_view text, double* value);
// The same, within +-kMaxCoordinate.
bool ParseCoordinate(absl::string_view text, float* value);
// The whole of `text` as a whole number of at most nine digits.
bool ParseInteger(absl::string_view text, int* value);

// The shortest text that reads back as the same number.
void AppendNumber(std::string* out, float value);
void AppendNumber(std::string* out, double value);
// Fixed notation; never "-0.000".
void AppendFixed(std::string* out, double value, int decimals);

// `text` in quotes for an error message: shortened, control characters escaped.
std::string Quoted(absl::string_view text);

// INVALID_ARGUMENT "source:line: message" or "source:line:column: message" (both from 1).
absl::Status ErrorAt(absl::string_view source, int line, absl::string_view message);
absl::Status ErrorAt(absl::string_view source, int line, int column, absl::string_view message);

// Refuses a rate that is no rate: "frame rate: came -3, wanted more than 0 and at most 1000 Hz".
absl::Status CheckFrameRate(absl::string_view source, double frame_rate_hz);

// Walks a text line by line, without the line ends (LF or CR LF).
//
//   LineReader lines(text);
//   for (absl::string_view line; lines.Next(&line);) ... lines.number() ...
class LineReader {
 public:
  explicit LineReader(absl::string_view text) : rest_(text) {}
  // False at the end of the text.
  bool Next(absl::string_view* line);
  // The number of the line that Next gave, from 1.
  int number() const { return number_; }

 private:
  absl::string_view rest_;
  int number_ = 0;
};

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_TEXT_H_
