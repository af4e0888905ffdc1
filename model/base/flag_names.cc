#include "model/base/flag_names.h"

#include <algorithm>

#include "absl/strings/match.h"

namespace duet::base {

KebabCaseCommandLine::KebabCaseCommandLine(int argc, const char* const* argv)
    : words_(argv, argv + argc) {
  for (std::size_t i = 1; i < words_.size() && words_[i] != "--"; ++i) {
    std::string& word = words_[i];
    if (!absl::StartsWith(word, "--")) continue;
    std::replace(word.begin(), std::find(word.begin(), word.end(), '='), '_', '-');
  }
  for (const std::string& word : words_) pointers_.push_back(word.c_str());
  pointers_.push_back(nullptr);
}

}  // namespace duet::base
