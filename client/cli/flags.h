#ifndef DUET_CLIENT_CLI_FLAGS_H_
#define DUET_CLIENT_CLI_FLAGS_H_

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/string_view.h"
#include "model/base/text.h"

// Kinds of flags that CLI11 lacks, with errors "--flag: expected ..., got ...".

namespace duet::client::cli {

// For use during parsing: a usage error about a flag, or about one that is missing.
[[noreturn]] inline void RejectFlag(const std::string& flag, const std::string& message) {
  throw CLI::ValidationError(flag, message);
}
[[noreturn]] inline void RejectMissing(const std::string& what) { throw CLI::RequiredError(what); }

// A flag whose value `parse` reads, for a `target` that `T` can be assigned to; --help shows the
// value as `form`.
template <typename T, typename Target>
CLI::Option* AddParsed(CLI::App* app, const std::string& flag, const std::string& form,
                       absl::StatusOr<T> (*parse)(absl::string_view), Target* target,
                       const std::string& help) {
  const auto read = [flag, parse, target](const std::string& word) {
    absl::StatusOr<T> value = parse(word);
    if (!value.ok()) RejectFlag(flag, std::string(value.status().message()));
    *target = *std::move(value);
  };
  return app->add_option_function<std::string>(flag, read, help)->type_name(form);
}

// Such a flag that can be repeated. Each takes one value, so that a file name that follows is never
// read as another one.
template <typename T>
CLI::Option* AddParsedList(CLI::App* app, const std::string& flag, const std::string& form,
                           absl::StatusOr<T> (*parse)(absl::string_view), std::vector<T>* target,
                           const std::string& help) {
  const auto read = [flag, parse, target](const std::vector<std::string>& words) {
    std::vector<T> values;
    for (const std::string& word : words) {
      absl::StatusOr<T> value = parse(word);
      if (!value.ok()) RejectFlag(flag, std::string(value.status().message()));
      values.push_back(*std::move(value));
    }
    *target = std::move(values);
  };
  return app->add_option_function<std::vector<std::string>>(flag, read, help)
      ->allow_extra_args(false)
      ->type_name(form);
}

// A flag with one of a few names, at least two. `names` outlives the app.
template <typename T, typename Target>
CLI::Option* AddChoice(CLI::App* app, const std::string& flag,
                       const std::map<std::string, T>& names, Target* target,
                       const std::string& help) {
  std::vector<std::string> allowed;
  for (const auto& [name, value] : names) allowed.push_back(name);
  const auto read = [&names, flag, target, allowed](const std::string& name) {
    const auto found = names.find(name);
    if (found == names.end()) {
      RejectFlag(flag,
                 absl::StrCat("expected ", absl::StrJoin(allowed.begin(), allowed.end() - 1, ", "),
                              " or ", allowed.back(), ", got ", base::Quoted(name)));
    }
    *target = found->second;
  };
  return app->add_option_function<std::string>(flag, read, help)
      ->type_name(absl::StrJoin(allowed, "|"));
}

// The name that AddChoice gives to `value`; every value has one.
template <typename T>
std::string NameOf(const std::map<std::string, T>& names, T value) {
  const auto has_value = [value](const auto& named) { return named.second == value; };
  return std::find_if(names.begin(), names.end(), has_value)->first;
}

// Accepts a finite number above 0. CLI11's own validator prints the largest double in --help.
inline CLI::Validator AboveZero() {
  const auto check = [](const std::string& text) {
    double value = 0;
    if (base::ParseNumber(text, &value) && value > 0) return std::string();
    return absl::StrCat("expected a number above 0, got ", base::Quoted(text));
  };
  return CLI::Validator(check, "");
}

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_FLAGS_H_
