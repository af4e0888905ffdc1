#ifndef DUET_CLIENT_CLI_SETTINGS_H_
#define DUET_CLIENT_CLI_SETTINGS_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::client::cli {

// The value of an environment variable; nothing for one that is not set.
using Variables = std::function<std::optional<std::string>(const std::string& name)>;

// A flag that counts where the command line does not have it.
struct Setting {
  std::string name;    // without its dashes: "server"
  std::string value;   // of a switch "true" or "false"
  std::string source;  // for errors: "DUET_SERVER" or "/home/ada/.config/duet/config:3"
};

// What the environment and the configuration file say, where they differ the environment's alone:
// DUET_SERVER, then the file that DUET_CONFIG names (empty: none), or else duet/config below
// XDG_CONFIG_HOME or ~/.config, which need not exist.
// Errors: what ParseSettings and reading the file have.
absl::StatusOr<std::vector<Setting>> ReadSettings(const Variables& variables);

// A configuration file: flags of any command without their dashes, one a line; a flag that may be
// repeated may have several lines.
//
//   # the lab's server
//   server = lab:50051
//   tls-ca = /etc/lab/ca.pem
//   quiet = true
//
// Errors: INVALID_ARGUMENT "source:line: ..." for a line of another kind.
absl::StatusOr<std::vector<Setting>> ParseSettings(absl::string_view text,
                                                   absl::string_view source);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SETTINGS_H_
