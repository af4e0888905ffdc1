#include "client/cli/usage_text.h"

#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"

namespace duet::client::cli {
namespace {

// The parts of a text before and after the first `separator`; two empty ones if it has none.
std::pair<absl::string_view, absl::string_view> Halves(absl::string_view text,
                                                       absl::string_view separator) {
  if (!absl::StrContains(text, separator)) return {};
  return absl::StrSplit(text, absl::MaxSplits(separator, 1));
}

std::string Values(absl::string_view count) {
  return count == "1" ? "one value" : absl::StrCat(count, " values");
}

}  // namespace

std::string UsageText(absl::string_view message) {
  // CLI11's releases differ in the case of "Least".
  for (const auto& [form, limit] :
       {std::pair<absl::string_view, absl::string_view>{": At Most ", "at most "},
        {": At Least ", "at least "},
        {": At least ", "at least "}}) {
    const auto [flag, counts] = Halves(message, form);
    const auto [expected, got] = Halves(counts, " required but received ");
    if (got.empty()) continue;
    return absl::StrCat(flag, ": expected ", expected == "1" ? "" : limit, Values(expected),
                        ", got ", got);
  }
  absl::string_view rest = message;
  if (absl::ConsumePrefix(&rest, "Expected exactly ")) {
    const auto [expected, place] = Halves(rest, " arguments to ");
    const auto [flag, got] = Halves(place, ", got ");
    if (!got.empty()) {
      return absl::StrCat(flag, ": expected ", Values(expected), ", got ", got);
    }
  }
  if (absl::EndsWith(message, " missing")) {
    const auto [flag, counts] = Halves(message, ": ");
    if (absl::StrContains(counts, " required ")) {
      return absl::StrCat(flag, ": expected a value, got none");
    }
  }
  for (const absl::string_view extra : {"The following argument was not expected: ",
                                        "The following arguments were not expected: "}) {
    if (absl::ConsumePrefix(&rest, extra)) {
      return absl::StrCat("Unexpected argument ", base::Quoted(rest));
    }
  }
  // Only switches: other values are checked before they are converted.
  if (absl::ConsumePrefix(&rest, "Could not convert: ")) {
    const auto [flag, value] = Halves(rest, " = ");
    return absl::StrCat(flag, ": expected true or false, got ", base::Quoted(value));
  }
  if (message == "A subcommand is required") return "A command is required";
  return std::string(message);
}

}  // namespace duet::client::cli
