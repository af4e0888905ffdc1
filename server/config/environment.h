#ifndef DUET_SERVER_CONFIG_ENVIRONMENT_H_
#define DUET_SERVER_CONFIG_ENVIRONMENT_H_

#include <map>
#include <string>

#include "absl/strings/string_view.h"

namespace duet::server::config {

// The variables that set what flags set begin so; --max-calls is DUET_SERVER_MAX_CALLS.
inline constexpr absl::string_view kVariablePrefix = "DUET_SERVER_";

// Environment variables by name.
using Environment = std::map<std::string, std::string>;

// Those of this process that begin with kVariablePrefix. Left out are the ones that Kubernetes sets
// in every container beside a Service named duet-server: DUET_SERVER_SERVICE_HOST,
// DUET_SERVER_PORT_50051_TCP and the like.
Environment ProcessEnvironment();

// The same of variables as a process has them: "NAME=value", then a null.
Environment ReadEnvironment(const char* const* variables);

// "--max-calls" of "DUET_SERVER_MAX_CALLS".
std::string FlagOfVariable(absl::string_view variable);
// "DUET_SERVER_MAX_CALLS" of "max-calls".
std::string VariableOfFlag(absl::string_view flag);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_ENVIRONMENT_H_
