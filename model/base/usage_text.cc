#include "model/base/usage_text.h"

#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"

namespace duet::base {
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

// "0.1" of "0.100000", which is how CLI11 prints the ends of a range.
std::string Plain(absl::string_view number) {
  double value = 0;
  std::string text;
  if (!ParseNumber(number, &value)) return std::string(number);
  AppendNumber(&text, value);
  return text;
}

// "1 to 256" of "range 1 to 256" and of "range [1 - 256]": CLI11's releases differ.
std::string Range(absl::string_view text) {
  if (absl::ConsumePrefix(&text, "[")) absl::ConsumeSuffix(&text, "]");
  for (const absl::string_view separator : {" to ", " - "}) {
    const auto [least, most] = Halves(text, separator);
    if (!most.empty()) return absl::StrCat(Plain(least), " to ", Plain(most));
  }
  return std::string(text);
}

// "a, b or c" of "{a,b,c}".
std::string Choices(absl::string_view text) {
  absl::ConsumePrefix(&text, "{");
  absl::ConsumeSuffix(&text, "}");
  std::vector<absl::string_view> choices = absl::StrSplit(text, ',');
  const absl::string_view last = choices.back();
  choices.pop_back();
  return absl::StrCat(absl::StrJoin(choices, ", "), choices.empty() ? "" : " or ", last);
}

// The error of a validator of CLI11 about the value of `flag`; empty if it is none.
std::string ValueText(absl::string_view flag, absl::string_view problem) {
  absl::string_view rest = problem;
  std::string expected;
  absl::string_view got;
  if (absl::ConsumePrefix(&rest, "Value ")) {
    const auto [value, range] = Halves(rest, " not in range ");
    if (!range.empty()) expected = Range(range);
    got = value;
  } else if (absl::ConsumePrefix(&rest, "Directory does not exist: ")) {
    expected = "a folder that exists";
    got = rest;
  } else if (const auto [value, choices] = Halves(rest, " not in {"); !choices.empty()) {
    expected = Choices(choices);
    got = value;
  }
  if (expected.empty()) return "";
  return absl::StrCat(flag, ": expected ", expected, ", got ", Quoted(got));
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
      return absl::StrCat("Unexpected argument ", Quoted(rest));
    }
  }
  // Only switches: other values are checked before they are converted.
  if (absl::ConsumePrefix(&rest, "Could not convert: ")) {
    const auto [flag, value] = Halves(rest, " = ");
    return absl::StrCat(flag, ": expected true or false, got ", Quoted(value));
  }
  if (const auto [flag, problem] = Halves(message, ": "); !problem.empty()) {
    if (std::string text = ValueText(flag, problem); !text.empty()) return text;
  }
  if (message == "A subcommand is required") return "A command is required";
  return std::string(message);
}

}  // namespace duet::base
