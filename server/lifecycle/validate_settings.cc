#include "server/lifecycle/validate_settings.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "server/common/listen_address.h"
#include "server/config/container_limits.h"
#include "server/config/memory_plan.h"
#include "server/lifecycle/load_models.h"
#include "server/lifecycle/process_end.h"
#include "server/metrics/process_metrics.h"
#include "server/registry/model_manager.h"
#include "server/registry/model_registry.h"
#include "server/registry/model_status.h"
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
  const std::optional<common::ListenAddress> address = common::AddressOf(setting);
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

namespace {

// Writes the result of loading each model.
class Findings final : public registry::ModelObserver {
 public:
  explicit Findings(std::ostream& out) : out_(out) {}

  void Loaded(const registry::LoadReport& report, bool) override {
    if (report.model.ok()) {
      out_ << "ok: " << report.source << "\n";
    } else {
      Problem(report.source + ": " + std::string(report.model.status().message()));
    }
  }
  void Unloaded(const std::string&) override {}
  void Forgotten(const std::string&) override {}
  void Scanned(const std::vector<registry::SkippedFolder>& skipped) override {
    for (const registry::SkippedFolder& folder : skipped) {
      Problem(folder.folder + ": skipped: " + folder.reason);
    }
  }
  void Reloaded(const absl::StatusOr<registry::ReloadReport>&) override {}
  void Changed() override {}

  void Problem(const std::string& problem) {
    for (absl::string_view line : absl::StrSplit(problem, '\n')) out_ << "wrong: " << line << "\n";
    all_right_ = false;
  }
  void Problems(const std::vector<std::string>& problems) {
    for (const std::string& problem : problems) Problem(problem);
  }
  void Problems(const absl::StatusOr<std::vector<std::string>>& problems) {
    if (!problems.ok()) return Problem(std::string(problems.status().message()));
    Problems(*problems);
  }
  void LeftOut(const std::vector<std::string>& sources) {
    if (sources.empty()) return;
    out_ << "left out, not free for all uses: " << absl::StrJoin(sources, ", ") << "\n";
  }
  bool all_right() const { return all_right_; }

 private:
  std::ostream& out_;
  bool all_right_ = true;
};

void CheckModels(const v1::ServerConfig& values, const registry::ModelSource& source,
                 Findings& findings, std::ostream& out) {
  registry::ModelRegistry registry;
  registry::ModelManager manager(registry, findings);
  ConfigureModels(values, manager);
  const auto loaded = LoadModels(
      values, source, [] { return false; }, manager, registry);
  if (loaded.ok()) {
    findings.Problems(loaded->problems);
    findings.LeftOut(loaded->left_out);
    findings.Problems(SettleModels(values, manager, registry));
  } else {
    findings.Problem(std::string(loaded.status().message()));
  }
  for (const std::string& warning :
       config::MemoryWarnings(values, config::AvailableMemory(), metrics::ResidentBytes())) {
    out << "warning: " << warning << "\n";
  }
}

}  // namespace

int CheckConfig(const ValidatedSettings& settings, std::ostream& out) {
  Findings findings(out);
  findings.Problems(settings.setting_mistakes);
  findings.Problems(settings.resource_mistakes);
  if (settings.source.ok()) CheckModels(settings.values, *settings.source, findings, out);
  if (!settings.setting_mistakes.empty()) return kExitUsage;
  return findings.all_right() ? kExitStopped : kExitFailed;
}

}  // namespace duet::server::lifecycle
