#ifndef DUET_MODEL_FORMATS_FLAT_UTF16_H_
#define DUET_MODEL_FORMATS_FLAT_UTF16_H_

#include <optional>
#include <string>

#include "absl/strings/string_view.h"

namespace duet::formats::flat {

// The text in UTF-8, without its byte order mark, if it is UTF-16 with one, as spreadsheets write
// "Unicode text". What is no valid character becomes U+FFFD.
std::optional<std::string> FromUtf16(absl::string_view bytes);

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_UTF16_H_
