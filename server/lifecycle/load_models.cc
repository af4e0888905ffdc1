#include "server/lifecycle/load_models.h"

#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/common/clock.h"
#include "server/registry/golden_check.h"

namespace duet::server::lifecycle {
namespace {

// Loads the checkpoints inside the program. The first is the default unless the operator names one.
absl::Status LoadEmbedded(const registry::ModelSource& source, registry::ModelManager& manager,
                          registry::ModelRegistry& registry) {
  const common::TimePoint begin = common::Clock::Real().Now();
  const auto models = source.load_embedded();
  const double seconds = common::SecondsBetween(begin, common::Clock::Real().Now());
  if (!models.ok()) {
    manager.Add({"embedded", models.status(), seconds});
    return absl::OkStatus();
  }
  for (const std::shared_ptr<const engine::Synthesizer>& model : *models) {
    const engine::ModelDescription& description = model->description();
    registry::LoadReport report{
        absl::StrCat("embedded/", description.name, "/", description.version), model,
        seconds / static_cast<double>(models->size())};
    const absl::Status checked = registry::CheckAnswers(*model);
    if (!checked.ok()) report.model = checked;
    manager.Add(report);
  }
  if (registry.List().empty()) return absl::OkStatus();
  return registry.SetDefault(models->front()->description().name);
}

}  // namespace

void ConfigureModels(const v1::ServerConfig& settings, registry::ModelManager& manager) {
  std::vector<registry::VersionLabel> labels;
  for (const v1::VersionLabel& label : settings.version_labels()) {
    labels.push_back({label.model(), label.label(), label.version()});
  }
  manager.SetLabels(std::move(labels));
  std::vector<registry::VersionPolicy> policies;
  for (const v1::VersionPolicy& message : settings.version_policies()) {
    registry::VersionPolicy policy;
    if (message.model() != "*") policy.model = message.model();
    if (message.has_latest()) policy.latest = message.latest();
    policy.versions.assign(message.versions().begin(), message.versions().end());
    policies.push_back(std::move(policy));
  }
  manager.SetPolicies(std::move(policies));
}

absl::StatusOr<std::vector<std::string>> LoadModels(const v1::ServerConfig& settings,
                                                    const registry::ModelSource& source,
                                                    const std::function<bool()>& stop,
                                                    registry::ModelManager& manager,
                                                    registry::ModelRegistry& registry) {
  if (settings.model_repository().empty()) {
    const absl::Status loaded = LoadEmbedded(source, manager, registry);
    if (!loaded.ok()) return loaded;
    return std::vector<std::string>();
  }
  manager.UseRepository(settings.model_repository(), source.load_folder);
  absl::StatusOr<registry::ReloadReport> report = manager.Reload(stop);
  if (!report.ok()) return report.status();
  return std::move(report->problems);
}

absl::StatusOr<std::vector<std::string>> SettleModels(const v1::ServerConfig& settings,
                                                      registry::ModelManager& manager,
                                                      registry::ModelRegistry& registry) {
  if (registry.List().empty()) return absl::FailedPreconditionError("no model could be loaded");
  if (const std::vector<std::string> unknown = manager.UnknownNames(); !unknown.empty()) {
    return absl::InvalidArgumentError(absl::StrJoin(unknown, "\n"));
  }
  // Set even if the operator names none: a model that is loaded later must not become the default.
  const absl::Status set = registry.SetDefault(
      settings.default_model().empty() ? registry.default_model() : settings.default_model());
  if (!set.ok()) return set;
  return manager.ApplyLabels();
}

}  // namespace duet::server::lifecycle
