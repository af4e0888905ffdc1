#ifndef DUET_TESTS_SERVER_SUPPORT_SETTINGS_H_
#define DUET_TESTS_SERVER_SUPPORT_SETTINGS_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/messages/message_text.h"
#include "server/config/load_config.h"

namespace duet::test {

// Fills in the defaults of `given`. Fails with every mistake.
inline absl::StatusOr<v1::ServerConfig> ResolveSettings(
    const v1::ServerConfig& given, int cores, const server::config::SettingSources& sources = {},
    std::uint64_t memory_bytes = server::config::kUnlimitedMemory) {
  server::config::CommandLine line;
  line.config = given;
  line.sources = sources;
  return server::config::ResolveSettings(line, cores, memory_bytes);
}

// Parses the text of a configuration file.
inline absl::StatusOr<v1::ServerConfig> ParseConfigText(absl::string_view text, bool json) {
  v1::ServerConfig config;
  const absl::Status status = messages::ParseMessage(
      text, json ? messages::MessageSyntax::kJson : messages::MessageSyntax::kTextFormat, &config);
  if (!status.ok()) return status;
  return config;
}

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_SETTINGS_H_
