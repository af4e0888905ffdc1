#include "server/config/environment.h"

#include <unistd.h>

#include <cstddef>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace duet::server::config {
namespace {

// No setting has such a name.
bool IsServiceLink(absl::string_view name) {
  return name == "SERVICE_HOST" || absl::StartsWith(name, "SERVICE_PORT") || name == "PORT" ||
         absl::StartsWith(name, "PORT_");
}

}  // namespace

Environment ReadEnvironment(const char* const* variables) {
  Environment environment;
  for (; *variables != nullptr; ++variables) {
    const absl::string_view variable = *variables;
    const std::size_t equals = variable.find('=');
    if (!absl::StartsWith(variable, kVariablePrefix) || equals == absl::string_view::npos) continue;
    const absl::string_view name = variable.substr(0, equals);
    if (IsServiceLink(name.substr(kVariablePrefix.size()))) continue;
    environment[std::string(name)] = std::string(variable.substr(equals + 1));
  }
  return environment;
}

Environment ProcessEnvironment() { return ReadEnvironment(environ); }

std::string FlagOfVariable(absl::string_view variable) {
  const std::string name = absl::AsciiStrToLower(variable.substr(kVariablePrefix.size()));
  return absl::StrCat("--", absl::StrReplaceAll(name, {{"_", "-"}}));
}

std::string VariableOfFlag(absl::string_view flag) {
  return absl::StrCat(kVariablePrefix,
                      absl::AsciiStrToUpper(absl::StrReplaceAll(flag, {{"-", "_"}})));
}

}  // namespace duet::server::config
