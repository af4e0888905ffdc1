#ifndef DUET_SERVER_CONFIG_SETTINGS_H_
#define DUET_SERVER_CONFIG_SETTINGS_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "duet/v1/server_config.pb.h"
#include "server/config/container_limits.h"

namespace duet::server::config {

// The source of each setting, for messages: "command line", "environment DUET_SERVER_MAX_CALLS" or
// "file duet.textproto:4:1". The key is the field as errors name it: "max_calls", or
// "version_labels[1]" for a value of a repeated field. Settings that are absent have their default.
using SettingSources = std::map<std::string, std::string>;

// A configuration with every default filled in, and its mistakes.
struct Settings {
  // Every field is set, except names, files and addresses that have no default. Listening addresses
  // are "host:port" or "off". A field with a mistake has some valid value.
  v1::ServerConfig values;
  // One line each: "field: expected ..., got ... (source, if known); hint".
  std::vector<std::string> mistakes;
};

// Fills in the defaults of `given` and checks every field, alone and against the others, without
// access to files or the network. `cores` and `memory_bytes` are what the container may use.
Settings ReadSettings(const v1::ServerConfig& given, int cores, const SettingSources& sources = {},
                      std::uint64_t memory_bytes = kUnlimitedMemory);

// Returns only the values. Fails with INVALID_ARGUMENT and every mistake.
absl::StatusOr<v1::ServerConfig> ResolveSettings(const v1::ServerConfig& given, int cores,
                                                 const SettingSources& sources = {},
                                                 std::uint64_t memory_bytes = kUnlimitedMemory);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_SETTINGS_H_
