#include "server/lifecycle/validate_settings.h"

#include <optional>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "server/common/bindable.h"
#include "server/lifecycle/secret_options.h"
#include "server/security/secret_files.h"

namespace duet::server::lifecycle {
namespace {

void Add(const absl::Status& status, std::vector<std::string>* mistakes) {
  for (absl::string_view line : absl::StrSplit(status.message(), '\n', absl::SkipEmpty())) {
    mistakes->emplace_back(line);
  }
}

void CheckSecrets(const config::SecurityOptions& options, std::vector<std::string>* mistakes) {
  security::SecretFiles::Options secrets = SecretsOf(options);
  // One without the other is a mistake of the settings.
  if (secrets.tls.key.empty()) secrets.tls.certificate.clear();
  Add(security::SecretFiles::Open(std::move(secrets)).status(), mistakes);
}

void CheckAddress(absl::string_view field, const std::optional<config::ListenAddress>& address,
                  Ports ports, std::vector<std::string>* mistakes) {
  // Without a host: a mistake of the settings.
  if (!address.has_value() || address->host.empty()) return;
  const absl::Status bindable = common::CheckBindable(address->host, address->port);
  if (bindable.ok() || (absl::IsAlreadyExists(bindable) && ports == Ports::kMayBeInUse)) return;
  mistakes->push_back(absl::StrCat(field, ": ", bindable.message()));
}

}  // namespace

ValidatedSettings ValidateSettings(const config::CommandLine& command_line, int cores,
                                   std::uint64_t memory_bytes, const EngineOpener& open_engine,
                                   Ports ports) {
  config::Settings settings = config::ReadSettings(command_line, cores, memory_bytes);
  ValidatedSettings validated{std::move(settings.options),
                              absl::UnknownError("not opened"),
                              std::move(settings.mistakes),
                              {}};
  const config::ServerOptions& options = validated.options;
  validated.source = open_engine(options.engine);
  Add(validated.source.status(), &validated.setting_mistakes);
  CheckSecrets(options.security, &validated.resource_mistakes);
  CheckAddress("listen", options.listen, ports, &validated.resource_mistakes);
  CheckAddress("metrics_listen", options.metrics_listen, ports, &validated.resource_mistakes);
  CheckAddress("admin_listen", options.admin_listen, ports, &validated.resource_mistakes);
  return validated;
}

}  // namespace duet::server::lifecycle
