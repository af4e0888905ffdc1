#ifndef DUET_MODEL_BASE_PRINTABLE_H_
#define DUET_MODEL_BASE_PRINTABLE_H_

#include <cstddef>
#include <string>

#include "absl/strings/string_view.h"

namespace duet::base {

// `text`, of whatever origin, as part of a line that people read: every byte that is not printable
// ASCII as an escape, and after the first `longest` bytes "...". Quotes stay as they are; a name
// that stands for itself reads better as Quoted (text.h).
std::string Printable(absl::string_view text, std::size_t longest);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_PRINTABLE_H_
