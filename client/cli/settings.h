#ifndef DUET_CLIENT_CLI_SETTINGS_H_
#define DUET_CLIENT_CLI_SETTINGS_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::client::cli {

// The value of an environment variable; nullopt if it is not set.
using Variables = std::function<std::optional<std::string>(const std::string& name)>;

// A flag that applies unless the command line has it.
struct Setting {
  std::string name;    // without its dashes: "server"
  std::string value;   // "true" or "false" for a switch
  std::string source;  // for errors: "DUET_SERVER" or "/home/ada/.config/duet/config:3"
};

// Reads the configuration file and the environment, which overrides it: DUET_SERVER sets the
// server; DUET_CONFIG names the file (empty: none). The default file is duet/config below
// XDG_CONFIG_HOME or
// ~/.config; it need not exist.
// Errors: those of ParseSettings and of base::ReadFile.
absl::StatusOr<std::vector<Setting>> ReadSettings(const Variables& variables);

// Parses a configuration file: flags of any command without their dashes, one on each line. A
// repeatable flag may have several lines.
//
//   # the lab's server
//   server = lab:50051
//   tls-ca = /etc/lab/ca.pem
//   quiet = true
//
// Errors: INVALID_ARGUMENT "source:line: ..." for any other line.
absl::StatusOr<std::vector<Setting>> ParseSettings(absl::string_view text,
                                                   absl::string_view source);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SETTINGS_H_
