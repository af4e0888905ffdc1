#ifndef DUET_MODEL_BASE_USAGE_TEXT_H_
#define DUET_MODEL_BASE_USAGE_TEXT_H_

#include <string>

#include "absl/strings/string_view.h"

namespace duet::base {

// A message of CLI11 about the words of a command line, in the form of all other errors:
// "--server: expected one value, got 2". Returns messages that have this form already as they are.
std::string UsageText(absl::string_view message);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_USAGE_TEXT_H_
