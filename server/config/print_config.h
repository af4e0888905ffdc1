#ifndef DUET_SERVER_CONFIG_PRINT_CONFIG_H_
#define DUET_SERVER_CONFIG_PRINT_CONFIG_H_

#include <string>

#include "server/config/server_options.h"
#include "server/config/setting_sources.h"

namespace duet::server::config {

// Every setting with its value and where that comes from, as a configuration file in text format:
//   max_calls: 64  # file duet.textproto:3:1
//   drain_seconds: 0  # default
std::string PrintConfig(const ServerOptions& options, const SettingSources& sources);

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_PRINT_CONFIG_H_
