#ifndef DUET_SERVER_CONFIG_PRINT_CONFIG_H_
#define DUET_SERVER_CONFIG_PRINT_CONFIG_H_

#include <string>

#include "duet/v1/server_config.pb.h"
#include "server/config/settings.h"

namespace duet::server::config {

// Formats every setting with its value and source as a configuration file in text format:
//   max_calls: 64  # file duet.textproto:3:1
//   drain_seconds: 0  # default
std::string PrintConfig(const v1::ServerConfig& settings, const SettingSources& sources);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_PRINT_CONFIG_H_
