#include "server/lifecycle/load_models.h"

#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/common/clock.h"
#include "server/registry/golden_check.h"

namespace duet::server::lifecycle {
namespace {

// The checkpoints linked into the program; the first is the default unless the operator says so.
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

void ConfigureModels(const config::ServerOptions& options, registry::ModelManager& manager) {
  std::vector<registry::VersionLabel> labels;
  for (const config::VersionLabelOption& label : options.version_labels) {
    labels.push_back({label.model, label.label, label.version});
  }
  manager.SetLabels(std::move(labels));
  std::vector<registry::VersionPolicy> policies;
  for (const config::VersionPolicyOption& policy : options.version_policies) {
    policies.push_back({policy.model, policy.latest, policy.versions});
  }
  manager.SetPolicies(std::move(policies));
}

absl::StatusOr<std::vector<std::string>> LoadModels(const config::ServerOptions& options,
                                                    const registry::ModelSource& source,
                                                    const std::function<bool()>& stop,
                                                    registry::ModelManager& manager,
                                                    registry::ModelRegistry& registry) {
  if (options.model_repository.empty()) {
    const absl::Status loaded = LoadEmbedded(source, manager, registry);
    if (!loaded.ok()) return loaded;
    return std::vector<std::string>();
  }
  manager.UseRepository(options.model_repository, source.load_folder);
  absl::StatusOr<registry::ReloadReport> report = manager.Reload(stop);
  if (!report.ok()) return report.status();
  return std::move(report->problems);
}

absl::StatusOr<std::vector<std::string>> SettleModels(const config::ServerOptions& options,
                                                      registry::ModelManager& manager,
                                                      registry::ModelRegistry& registry) {
  if (registry.List().empty()) return absl::FailedPreconditionError("no model could be loaded");
  if (const std::vector<std::string> unknown = manager.UnknownNames(); !unknown.empty()) {
    return absl::InvalidArgumentError(absl::StrJoin(unknown, "\n"));
  }
  // Set even where the operator names none: a model that comes later must not become the default.
  const absl::Status set = registry.SetDefault(
      options.default_model.empty() ? registry.default_model() : options.default_model);
  if (!set.ok()) return set;
  return manager.ApplyLabels();
}

}  // namespace duet::server::lifecycle
