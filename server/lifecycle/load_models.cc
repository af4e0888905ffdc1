#include "server/lifecycle/load_models.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/common/clock.h"

namespace duet::server::lifecycle {
namespace {

using Model = std::shared_ptr<const engine::Synthesizer>;

bool ServesOnlyFree(const v1::ServerConfig& settings) {
  return settings.models() == v1::SERVED_MODELS_FREE;
}

// Rejects checkpoints that are not free for all uses.
registry::ModelLoader OnlyFree(registry::ModelLoader load) {
  return [load = std::move(load)](const std::filesystem::path& folder) -> absl::StatusOr<Model> {
    absl::StatusOr<Model> model = load(folder);
    if (!model.ok() || (*model)->description().free_for_all_uses) return model;
    return absl::FailedPreconditionError(
        "free_for_all_uses: expected true because of the setting models, got false");
  };
}

std::string SourceOf(const Model& model) {
  const engine::ModelDescription& description = model->description();
  return absl::StrCat("embedded/", description.name, "/", description.version);
}

// Loads the checkpoints inside the program. The first that the settings allow is the default unless
// the operator names one.
absl::Status LoadEmbedded(const v1::ServerConfig& settings, const registry::ModelSource& source,
                          registry::ModelManager& manager, registry::ModelRegistry& registry) {
  const common::TimePoint begin = common::Clock::Real().Now();
  absl::StatusOr<std::vector<Model>> models = source.load_embedded();
  const double seconds = common::SecondsBetween(begin, common::Clock::Real().Now());
  if (!models.ok()) {
    manager.Add({"embedded", models.status(), seconds});
    return absl::OkStatus();
  }
  const double seconds_each = seconds / static_cast<double>(models->size());
  if (ServesOnlyFree(settings)) {
    const auto is_bound = [](const Model& model) {
      return !model->description().free_for_all_uses;
    };
    models->erase(std::remove_if(models->begin(), models->end(), is_bound), models->end());
  }
  for (const Model& model : *models) {
    registry::LoadReport report{SourceOf(model), model, seconds_each};
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
}

absl::StatusOr<std::vector<std::string>> LoadModels(const v1::ServerConfig& settings,
                                                    const registry::ModelSource& source,
                                                    const std::function<bool()>& stop,
                                                    registry::ModelManager& manager,
                                                    registry::ModelRegistry& registry) {
  if (settings.model_repository().empty()) {
    const absl::Status loaded = LoadEmbedded(settings, source, manager, registry);
    if (!loaded.ok()) return loaded;
    return std::vector<std::string>();
  }
  manager.UseRepository(settings.model_repository(), ServesOnlyFree(settings)
                                                         ? OnlyFree(source.load_folder)
                                                         : source.load_folder);
  absl::StatusOr<registry::ReloadReport> report = manager.Reload(stop);
  if (!report.ok()) return report.status();
  return std::move(report->problems);
}

absl::StatusOr<std::vector<std::string>> SettleModels(const v1::ServerConfig& settings,
                                                      registry::ModelManager& manager,
                                                      registry::ModelRegistry& registry) {
  if (registry.List().empty()) {
    return absl::FailedPreconditionError(
        absl::StrCat("no model could be loaded",
                     ServesOnlyFree(settings)
                         ? "; models: expected at least one that is free for all uses, got none"
                         : ""));
  }
  if (const std::vector<std::string> unknown = manager.UnknownNames(); !unknown.empty()) {
    return absl::InvalidArgumentError(absl::StrJoin(unknown, "\n"));
  }
  // Set even if the operator names none: a model that is loaded later must not become the default.
  const absl::Status set = registry.SetDefault(
      settings.default_model().empty() ? registry.default_model() : settings.default_model());
  if (!set.ok()) return set;
  return manager.ApplyLabels();
}

void ModelEvents::Loaded(const registry::LoadReport& report, bool still_served) {
  const bool served = report.model.ok() || still_served;
  metrics_.ModelLoaded(report.source, report.load_seconds, report.model.ok(), served);
  if (!report.model.ok()) {
    log_.Error("model_refused", {{"source", report.source},
                                 {"message", report.model.status().ToString()},
                                 {"still_served", still_served}});
    return;
  }
  const engine::ModelDescription& model = (*report.model)->description();
  log_.Info("model_loaded", {{"source", report.source},
                             {"model", model.name},
                             {"version", model.version},
                             {"seconds", report.load_seconds}});
}

void ModelEvents::Unloaded(const std::string& source) {
  metrics_.ModelUnloaded(source);
  log_.Info("model_unloaded", {{"source", source}});
}

void ModelEvents::Forgotten(const std::string& source) { metrics_.ModelUnloaded(source); }

void ModelEvents::Scanned(const std::vector<registry::SkippedFolder>& skipped) {
  metrics_.FoldersSkipped(static_cast<int>(skipped.size()));
  common::MutexLock lock(mutex_);
  for (const registry::SkippedFolder& folder : skipped) {
    if (std::find(logged_.begin(), logged_.end(), folder) != logged_.end()) continue;
    log_.Error("folder_skipped", {{"folder", folder.folder}, {"message", folder.reason}});
  }
  logged_ = skipped;
}

void ModelEvents::Reloaded(const absl::StatusOr<registry::ReloadReport>& report) {
  metrics_.Reloaded(report.ok() && report->ok());
  if (!report.ok()) {
    log_.Error("reload_failed", {{"message", std::string(report.status().message())}});
    return;
  }
  for (const std::string& problem : report->problems) {
    log_.Error("reload_problem", {{"message", problem}});
  }
  for (const std::string& label : report->refused_labels) {
    log_.Error("version_label_refused", {{"message", label}});
  }
  log_.Info("reloaded", {{"loaded", report->loaded},
                         {"refused", report->refused},
                         {"unloaded", report->unloaded},
                         {"unchanged", report->unchanged}});
}

}  // namespace duet::server::lifecycle
