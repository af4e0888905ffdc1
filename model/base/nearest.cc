#include "model/base/nearest.h"

#include <algorithm>
#include <cstddef>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"

namespace duet::base {
namespace {

// Longer texts are not misspelt names, and comparing them is slow.
constexpr std::size_t kLongestName = 64;

// Edit distance with swaps of neighbours (optimal string alignment).
std::size_t Slips(absl::string_view a, absl::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

}  // namespace

std::optional<std::string> Nearest(absl::string_view text, const std::vector<std::string>& known) {
  if (text.size() > kLongestName) return std::nullopt;
  const std::string lower = absl::AsciiStrToLower(text);
  const std::string* best = nullptr;
  std::size_t fewest = kLongestName;
  for (const std::string& name : known) {
    if (name == text) return std::nullopt;
    if (name.size() > kLongestName) continue;
    const std::size_t slips = Slips(lower, absl::AsciiStrToLower(name));
    if (slips * 3 > std::max(name.size(), text.size()) || slips >= fewest) continue;
    best = &name;
    fewest = slips;
  }
  return best == nullptr ? std::nullopt : std::optional<std::string>(*best);
}

std::string DidYouMean(absl::string_view text, const std::vector<std::string>& known) {
  const std::optional<std::string> nearest = Nearest(text, known);
  return nearest.has_value() ? absl::StrCat("; did you mean ", *nearest, "?") : "";
}

}  // namespace duet::base
