#ifndef DUET_MODEL_BASE_COUNTED_H_
#define DUET_MODEL_BASE_COUNTED_H_

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"

namespace duet::base {

// "1 pair", "2 pairs", "0 people". The default plural ends in "s".
template <typename Count>
std::string Counted(Count count, absl::string_view singular, absl::string_view plural = {}) {
  if (count == 1) return absl::StrCat(count, " ", singular);
  return plural.empty() ? absl::StrCat(count, " ", singular, "s")
                        : absl::StrCat(count, " ", plural);
}

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_COUNTED_H_
