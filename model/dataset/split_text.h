#ifndef DUET_MODEL_DATASET_SPLIT_TEXT_H_
#define DUET_MODEL_DATASET_SPLIT_TEXT_H_

#include <string_view>
#include <vector>

namespace duet {

// The pieces of `text` between separators, empty ones included. They point into `text`.
// (absl::StrSplit of Debian's abseil knows no std::string_view.)
inline std::vector<std::string_view> SplitText(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  for (;;) {
    const size_t end = text.find(separator);
    pieces.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return pieces;
    text.remove_prefix(end + 1);
  }
}

// `text` without spaces, tabs and carriage returns at its ends.
inline std::string_view TrimText(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

}  // namespace duet

#endif  // DUET_MODEL_DATASET_SPLIT_TEXT_H_
