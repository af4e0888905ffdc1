#ifndef DUET_MODEL_BASE_HEX_H_
#define DUET_MODEL_BASE_HEX_H_

#include <string>

#include "absl/strings/string_view.h"

namespace duet::base {

// The bytes that pairs of hexadecimal digits write. Requires an even number of characters, all of
// them hexadecimal digits. Newer versions of abseil deprecate their function of this form.
std::string BytesOfHex(absl::string_view digits);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_HEX_H_
