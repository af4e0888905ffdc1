#ifndef DUET_SERVER_CONFIG_SETTING_SOURCES_H_
#define DUET_SERVER_CONFIG_SETTING_SOURCES_H_

#include <map>
#include <string>

namespace duet::server::config {

// The source of each setting, for messages: "command line", "environment DUET_SERVER_MAX_CALLS" or
// "file duet.textproto:4:1". The key is the field as errors name it: "max_calls", or
// "version_labels[1]" for a value of a repeated field. Settings that are absent have their default.
using SettingSources = std::map<std::string, std::string>;

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_SETTING_SOURCES_H_
