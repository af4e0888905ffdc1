#include "server/lifecycle/check_config.h"

#include <string>
#include <vector>

#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "server/config/container_limits.h"
#include "server/config/memory_plan.h"
#include "server/lifecycle/load_models.h"
#include "server/metrics/process_metrics.h"
#include "server/registry/model_manager.h"
#include "server/registry/model_registry.h"
#include "server/registry/model_status.h"
#include "server/watchdog/exit_codes.h"

namespace duet::server::lifecycle {
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
  using watchdog::kExitFailed;
  using watchdog::kExitStopped;
  using watchdog::kExitUsage;
  Findings findings(out);
  findings.Problems(settings.setting_mistakes);
  findings.Problems(settings.resource_mistakes);
  if (settings.source.ok()) CheckModels(settings.values, *settings.source, findings, out);
  if (!settings.setting_mistakes.empty()) return kExitUsage;
  return findings.all_right() ? kExitStopped : kExitFailed;
}

}  // namespace duet::server::lifecycle
