#ifndef DUET_MODEL_BASE_TEXT_H_
#define DUET_MODEL_BASE_TEXT_H_

#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

// Text that people and other programs wrote: strict numbers that do not depend on the locale,
// lines, quotes, and errors that point at a place in a file.

namespace duet::base {

// The whole of `text` as one finite number; false otherwise. A leading '+' and surrounding blanks
// are allowed.
bool ParseNumber(absl::string_view text, double* value);
// The whole of `text` as a whole number of at most nine digits.
bool ParseInteger(absl::string_view text, int* value);

// The shortest text that reads back as the same number.
void AppendNumber(std::string* out, float value);
void AppendNumber(std::string* out, double value);
// Fixed notation; never "-0.000".
void AppendFixed(std::string* out, double value, int decimals);

// `text` in double quotes, for a message: every byte that is not printable ASCII as an escape, as
// are double quotes and backslashes, and after the first kLongestQuote bytes "...". Whatever came
// stands in one short line.
inline constexpr std::size_t kLongestQuote = 64;
std::string Quoted(absl::string_view text);

// INVALID_ARGUMENT "source:line: message" or "source:line:column: message" (both from 1).
absl::Status ErrorAt(absl::string_view source, int line, absl::string_view message);
absl::Status ErrorAt(absl::string_view source, int line, int column, absl::string_view message);

// `text` without the byte order mark that some editors and spreadsheets write.
absl::string_view SkipByteOrderMark(absl::string_view text);

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
