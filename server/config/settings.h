#ifndef DUET_SERVER_CONFIG_SETTINGS_H_
#define DUET_SERVER_CONFIG_SETTINGS_H_

#include <google/protobuf/descriptor.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "duet/v1/options.pb.h"
#include "duet/v1/server_config.pb.h"
#include "server/config/container_limits.h"

namespace duet::server::config {

// The prefix of variables that set what flags set: DUET_SERVER_MAX_CALLS for --max-calls.
inline constexpr absl::string_view kVariablePrefix = "DUET_SERVER_";

// A value of an enum, as flags and as configuration files spell it.
struct Choice {
  std::string flag_value;  // "auto"
  std::string name;        // "CLEAN_UP_POLICY_AUTO"
  int number = 0;
};

// The values of an enum that may be set: all but the one of number 0.
std::vector<Choice> ChoicesOf(const google::protobuf::EnumDescriptor& type);

// A field of duet.v1.ServerConfig, described by its option (duet/v1/options.proto). Cheap to copy.
class Setting {
 public:
  using Field = google::protobuf::FieldDescriptor;

  explicit Setting(const Field* field) : field_(field) {}
  // `number`: such as v1::ServerConfig::kMaxCallsFieldNumber.
  explicit Setting(int number)
      : Setting(v1::ServerConfig::descriptor()->FindFieldByNumber(number)) {}

  const Field& field() const { return *field_; }
  const v1::SettingOptions& options() const { return field_->options().GetExtension(v1::setting); }
  const std::string& name() const { return field_->name(); }  // "max_calls"
  std::string flag() const;                                   // "max-calls"
  std::string variable() const;                               // "DUET_SERVER_MAX_CALLS"
  // Unit or choices of a value, such as "BYTES" or "auto|on|off". Empty for a boolean.
  std::string unit() const;
  // The value that a flag would set, such as "128" or "on", or a text. Empty if there is no
  // default.
  std::string default_text() const;
  // One paragraph, with the default.
  std::string help() const;

  // Sets the field to a value that is spelled as on the command line, or adds it to a repeated
  // field. Fails with INVALID_ARGUMENT "expected ..., got ...". Ranges are checked elsewhere.
  absl::Status Set(const std::string& text, v1::ServerConfig* config) const;
  // Sets the field to its default, if that does not have to be computed.
  void SetDefault(v1::ServerConfig* config) const;

 private:
  absl::Status SetChoice(const std::string& text, v1::ServerConfig* config) const;

  const Field* field_;
};

// Every setting, in the order of the schema.
std::vector<Setting> AllSettings();

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

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_SETTINGS_H_
