#ifndef DUET_SERVER_CONFIG_SETTING_SOURCES_H_
#define DUET_SERVER_CONFIG_SETTING_SOURCES_H_

#include <map>
#include <string>

namespace duet::server::config {

// Where the value of a setting comes from, for people: "flag --max-calls", "environment
// DUET_SERVER_MAX_CALLS", "file duet.textproto:4:1". By the field as errors name it: "max_calls",
// or of a repeated one "version_labels[1]". What is absent has its default.
using SettingSources = std::map<std::string, std::string>;

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_SETTING_SOURCES_H_
