#ifndef DUET_CLIENT_CLI_FLAGS_H_
#define DUET_CLIENT_CLI_FLAGS_H_

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "model/base/text.h"

// Kinds of flags that CLI11 lacks, with errors "--flag: expected ..., got ...".

namespace duet::client::cli {

// For use during parsing: a usage error about a flag, or about one that is missing.
[[noreturn]] inline void RejectFlag(const std::string& flag, const std::string& message) {
  throw CLI::ValidationError(flag, message);
}
[[noreturn]] inline void RejectMissing(const std::string& what) { throw CLI::RequiredError(what); }

// A flag that takes a value. --help shows it in `group`, and its value as `form`.
template <typename Target>
CLI::Option* AddValue(CLI::App* app, const char* group, const std::string& flag,
                      const std::string& form, Target* target, const std::string& help) {
  return app->add_option(flag, *target, help)->type_name(form)->group(group);
}

// A flag whose value `parse` reads, for a `target` that `T` can be assigned to; --help shows the
// value as `form`.
template <typename T, typename Target>
CLI::Option* AddParsed(CLI::App* app, const char* group, const std::string& flag,
                       const std::string& form, absl::StatusOr<T> (*parse)(absl::string_view),
                       Target* target, const std::string& help) {
  const auto read = [flag, parse, target](const std::string& word) {
    absl::StatusOr<T> value = parse(word);
    if (!value.ok()) RejectFlag(flag, std::string(value.status().message()));
    *target = *std::move(value);
  };
  return app->add_option_function<std::string>(flag, read, help)->type_name(form)->group(group);
}

// Such a flag that can be repeated. Each takes one value, so that a file name that follows is never
// read as another one.
template <typename T>
CLI::Option* AddParsedList(CLI::App* app, const char* group, const std::string& flag,
                           const std::string& form, absl::StatusOr<T> (*parse)(absl::string_view),
                           std::vector<T>* target, const std::string& help) {
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
      ->type_name(form)
      ->group(group);
}

// --json and --quiet.
inline void AddSummaryFlags(CLI::App* app, const char* group, bool* json, bool* quiet) {
  app->add_flag("--json", *json, "Print the summary as JSON")->group(group);
  app->add_flag("--quiet", *quiet, "Print only errors")->group(group);
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
