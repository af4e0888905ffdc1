#ifndef DUET_MODEL_BASE_NEAREST_H_
#define DUET_MODEL_BASE_NEAREST_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace duet::base {

// The known name at the smallest edit distance from `text`, ignoring case; the first if several are
// equally near. An edit inserts, deletes or changes a letter or swaps two neighbours. Absent if the
// distance exceeds a third of the longer name's length, or if `text` is a known name.
std::optional<std::string> Nearest(absl::string_view text, const std::vector<std::string>& known);

// "; did you mean kick?", or an empty string. Append it to a message about an unknown name.
std::string DidYouMean(absl::string_view text, const std::vector<std::string>& known);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_NEAREST_H_
