#ifndef DUET_SERVER_CONFIG_REPEATED_VALUE_H_
#define DUET_SERVER_CONFIG_REPEATED_VALUE_H_

#include <string>

#include "absl/status/status.h"
#include "duet/v1/server_config.pb.h"
#include "server/config/setting.h"

namespace duet::server::config {

// Adds a value of a repeated setting, spelled as on the command line: "model:label=version" for a
// VersionLabel; "model=all", "model=latest:2" or "model=1,3" for a VersionPolicy.
// Fails with INVALID_ARGUMENT "expected ..., got ...".
absl::Status AddValue(const Setting& setting, const std::string& text, v1::ServerConfig* config);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_REPEATED_VALUE_H_
