#include "server/lifecycle/model_events.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace duet::server::lifecycle {

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
