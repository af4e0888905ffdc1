#ifndef DUET_CLIENT_CLI_FLAGS_H_
#define DUET_CLIENT_CLI_FLAGS_H_

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_join.h"
#include "absl/strings/string_view.h"
#include "client/cli/flag_set.h"

// Kinds of flags with values of any type.

namespace duet::client::cli {

// A flag whose value `parse` reads; --help shows the value as `form`. Each flag takes one value, so
// that a file name that follows is never read as another value.
template <typename T>
Flag* AddParsed(FlagSet* app, const std::string& flag, const std::string& form,
                absl::StatusOr<T> (*parse)(absl::string_view), std::function<void(T)> sink,
                const std::string& help) {
  const auto read = [flag, parse, sink = std::move(sink)](const std::vector<std::string>& values) {
    for (const std::string& value : values) {
      absl::StatusOr<T> parsed = parse(value);
      if (!parsed.ok()) RejectFlag(flag, std::string(parsed.status().message()));
      sink(*std::move(parsed));
    }
  };
  return app->AddListReader(flag, read, help)->OneValueEach()->Form(form);
}

// A flag with one of a few names. `names` outlives the app.
template <typename T>
Flag* AddChoice(FlagSet* app, const std::string& flag, const std::map<std::string, T>& names,
                std::function<void(T)> sink, const std::string& help) {
  std::vector<std::string> allowed;
  allowed.reserve(names.size());
  for (const auto& [name, value] : names) allowed.push_back(name);
  const auto read = [&names, sink = std::move(sink)](const std::string& name) {
    sink(names.at(name));
  };
  return app->AddReader(flag, read, help)->OneOf(allowed)->Form(absl::StrJoin(allowed, "|"));
}

// The name that AddChoice gives to `value`; every value has one.
template <typename T>
std::string NameOf(const std::map<std::string, T>& names, T value) {
  const auto has_value = [value](const auto& named) { return named.second == value; };
  return std::find_if(names.begin(), names.end(), has_value)->first;
}

// Collects the values of a repeated flag.
template <typename T>
std::function<void(T)> AppendTo(std::vector<T>* values) {
  return [values](T value) { values->push_back(std::move(value)); };
}

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_FLAGS_H_
