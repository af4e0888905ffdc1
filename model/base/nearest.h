#ifndef DUET_MODEL_BASE_NEAREST_H_
#define DUET_MODEL_BASE_NEAREST_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace duet::base {

// The known name that somebody who wrote `text` most likely meant: the one that the fewest slips
// turn it into (a letter added, left out, changed, or two that are swapped; case does not count),
// the first of several. Nothing where all are farther than a third of the longer name's letters,
// or `text` is one of them.
std::optional<std::string> Nearest(absl::string_view text, const std::vector<std::string>& known);

// "; did you mean kick?", or nothing: for the end of a message about an unknown name.
std::string DidYouMean(absl::string_view text, const std::vector<std::string>& known);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_NEAREST_H_
