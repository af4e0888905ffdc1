#ifndef DUET_MODEL_BASE_PRINTABLE_H_
#define DUET_MODEL_BASE_PRINTABLE_H_

#include <cstddef>
#include <string>

#include "absl/strings/string_view.h"

namespace duet::base {

// Makes untrusted `text` safe to print within a line: escapes every byte that is not printable
// ASCII, and replaces everything after the first `longest` bytes by "...". Quotes are not escaped.
// For a name, prefer Quoted (text.h).
std::string Printable(absl::string_view text, std::size_t longest);

// Escapes control characters, with which a name could move a terminal's cursor or end the line, and
// keeps letters of every script. For names in reports; errors use Quoted or Printable.
std::string EscapeControls(absl::string_view text);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_PRINTABLE_H_
