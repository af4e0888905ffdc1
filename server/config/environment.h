#ifndef DUET_SERVER_CONFIG_ENVIRONMENT_H_
#define DUET_SERVER_CONFIG_ENVIRONMENT_H_

#include <map>
#include <string>

#include "absl/strings/string_view.h"

namespace duet::server::config {

// The prefix of variables that set what flags set: DUET_SERVER_MAX_CALLS for --max-calls.
inline constexpr absl::string_view kVariablePrefix = "DUET_SERVER_";

// Environment variables by name.
using Environment = std::map<std::string, std::string>;

// Returns the variables of this process that begin with kVariablePrefix, except those that
// Kubernetes sets in every container beside a Service named duet-server: DUET_SERVER_SERVICE_HOST,
// DUET_SERVER_PORT_50051_TCP and the like.
Environment ProcessEnvironment();

// Does the same for a null-terminated array of "NAME=value".
Environment ReadEnvironment(const char* const* variables);

// "--max-calls" for "DUET_SERVER_MAX_CALLS".
std::string FlagOfVariable(absl::string_view variable);
// "DUET_SERVER_MAX_CALLS" for "max-calls".
std::string VariableOfFlag(absl::string_view flag);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_ENVIRONMENT_H_
