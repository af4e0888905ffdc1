#ifndef DUET_MODEL_BASE_TEXT_H_
#define DUET_MODEL_BASE_TEXT_H_

#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

// Helpers to read text from people and other programs: strict numbers independent of the locale,
// lines, quotes, and errors that name a place in a file.

namespace duet::base {

// Parses all of `text` as one finite number; returns false otherwise. Allows a leading '+' and
// surrounding white space.
bool ParseNumber(absl::string_view text, double* value);
// Parses all of `text` as an integer of at most nine digits.
bool ParseInteger(absl::string_view text, int* value);

// Appends the shortest text that parses to the same number.
void AppendNumber(std::string* out, float value);
void AppendNumber(std::string* out, double value);
// The same as a text of its own, for messages about limits: absl::StrCat prints six digits, with
// which 2.0000002 is "2".
std::string NumberText(float value);
std::string NumberText(double value);
// Appends fixed notation; never "-0.000".
void AppendFixed(std::string* out, double value, int decimals);

// Quotes untrusted `text` for a message: adds double quotes, escapes double quotes, backslashes and
// every byte that is not printable ASCII, and replaces everything after the first kLongestQuote
// bytes by "...". The result is one short line.
inline constexpr std::size_t kLongestQuote = 64;
std::string Quoted(absl::string_view text);

// Makes untrusted `text` safe to print within a line: escapes every byte that is not printable
// ASCII, and replaces everything after the first `longest` bytes by "...". Quotes are not escaped.
// For a name, prefer Quoted.
std::string Printable(absl::string_view text, std::size_t longest);

// Escapes control characters, with which a name could move a terminal's cursor or end the line, and
// keeps letters of every script. For names in reports; errors use Quoted or Printable.
std::string EscapeControls(absl::string_view text);

// INVALID_ARGUMENT "source:line: message" or "source:line:column: message" (both from 1).
absl::Status ErrorAt(absl::string_view source, int line, absl::string_view message);
absl::Status ErrorAt(absl::string_view source, int line, int column, absl::string_view message);

// `text` without the byte order mark that some editors and spreadsheets write.
absl::string_view SkipByteOrderMark(absl::string_view text);

// Walks a text line by line, without the line ends: LF or CR LF, or CR in a text without LF.
//
//   LineReader lines(text);
//   for (absl::string_view line; lines.Next(&line);) ... lines.number() ...
class LineReader {
 public:
  explicit LineReader(absl::string_view text);
  // False at the end of the text.
  bool Next(absl::string_view* line);
  // The number of the line that Next returned last, from 1.
  int number() const { return number_; }

 private:
  absl::string_view rest_;
  char end_;
  int number_ = 0;
};

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_TEXT_H_
