#include "server/lifecycle/validate_settings.h"

#include <optional>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "server/common/bindable.h"
#include "server/config/listen_address.h"
#include "server/security/secret_files.h"

namespace duet::server::lifecycle {
namespace {

void Add(const absl::Status& status, std::vector<std::string>* mistakes) {
  for (absl::string_view line : absl::StrSplit(status.message(), '\n', absl::SkipEmpty())) {
    mistakes->emplace_back(line);
  }
}

void CheckSecrets(const v1::ServerConfig& settings, std::vector<std::string>* mistakes) {
  security::SecretFiles::Options secrets = SecretsOf(settings);
  // A certificate without a key is a mistake in the settings, and reported there.
  if (secrets.tls.key.empty()) secrets.tls.certificate.clear();
  Add(security::SecretFiles::Open(std::move(secrets)).status(), mistakes);
}

void CheckAddress(absl::string_view field, const std::string& setting, Ports ports,
                  std::vector<std::string>* mistakes) {
  const std::optional<config::ListenAddress> address = config::AddressOf(setting);
  if (!address.has_value()) return;
  const absl::Status bindable = common::CheckBindable(address->host, address->port);
  if (bindable.ok() || (absl::IsAlreadyExists(bindable) && ports == Ports::kMayBeInUse)) return;
  mistakes->push_back(absl::StrCat(field, ": ", bindable.message()));
}

}  // namespace

ValidatedSettings ValidateSettings(const config::CommandLine& command_line, int cores,
                                   std::uint64_t memory_bytes, const EngineOpener& open_engine,
                                   Ports ports) {
  config::Settings settings = config::ReadSettings(command_line, cores, memory_bytes);
  ValidatedSettings validated{std::move(settings.values),
                              absl::UnknownError("not opened"),
                              std::move(settings.mistakes),
                              {}};
  const v1::ServerConfig& values = validated.values;
  validated.source = open_engine(values);
  Add(validated.source.status(), &validated.setting_mistakes);
  CheckSecrets(values, &validated.resource_mistakes);
  CheckAddress("listen", values.listen(), ports, &validated.resource_mistakes);
  CheckAddress("metrics_listen", values.metrics_listen(), ports, &validated.resource_mistakes);
  CheckAddress("admin_listen", values.admin_listen(), ports, &validated.resource_mistakes);
  return validated;
}

}  // namespace duet::server::lifecycle
