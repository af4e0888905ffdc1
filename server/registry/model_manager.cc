#include "server/registry/model_manager.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/text.h"

namespace duet::server::registry {

namespace {

namespace fs = std::filesystem;

absl::Status Stopping() { return absl::CancelledError("the server is stopping"); }

std::string SourceOf(absl::string_view name, uint32_t version) {
  return absl::StrCat(name, "/", version);
}

}  // namespace

void ModelManager::UseRepository(fs::path repository, ModelLoader loader) {
  common::MutexLock lock(mutex_);
  repository_ = std::move(repository);
  loader_ = std::move(loader);
}

void ModelManager::SetLabels(std::vector<VersionLabel> labels) {
  common::MutexLock lock(mutex_);
  labels_ = std::move(labels);
}

std::vector<std::string> ModelManager::ApplyLabels() { return ApplyLabelsOf(""); }

std::vector<std::string> ModelManager::ApplyLabelsOf(absl::string_view name) {
  const auto contains = [](const std::vector<VersionLabel>& labels, const VersionLabel& label) {
    return std::find(labels.begin(), labels.end(), label) != labels.end();
  };
  std::vector<VersionLabel> wanted;
  std::vector<VersionLabel> applied;
  {
    common::MutexLock lock(mutex_);
    wanted = labels_;
    applied = applied_labels_;
  }
  std::vector<VersionLabel> now;
  std::vector<std::string> problems;
  for (const VersionLabel& label : applied) {
    if (!name.empty() && label.model != name) {
      now.push_back(label);
      continue;
    }
    const bool goes = std::none_of(wanted.begin(), wanted.end(), [&](const VersionLabel& other) {
      return other.model == label.model && other.label == label.label;
    });
    // The operator may have deleted it already.
    if (goes) registry_.DeleteLabel(label.model, label.label).IgnoreError();
  }
  for (const VersionLabel& label : wanted) {
    if (!name.empty() && label.model != name) continue;
    const absl::Status set = contains(applied, label)
                                 ? absl::OkStatus()
                                 : registry_.SetLabel(label.model, label.label, label.version);
    if (set.ok()) now.push_back(label);
    if (!set.ok()) problems.emplace_back(set.message());
  }
  common::MutexLock lock(mutex_);
  applied_labels_ = std::move(now);
  return problems;
}

void ModelManager::Add(const LoadReport& report) {
  if (!report.model.ok()) {
    observer_.Loaded(report, /*still_served=*/false);
    return;
  }
  const engine::ModelDescription& model = (*report.model)->description();
  Take(model.name, static_cast<uint32_t>(model.version), report, "");
}

absl::StatusOr<ModelManager::Folders> ModelManager::Scan() {
  fs::path repository;
  {
    common::MutexLock lock(mutex_);
    repository = repository_;
  }
  absl::StatusOr<RepositoryListing> listing = ListCheckpoints(repository);
  if (!listing.ok()) return listing.status();
  Folders folders;
  for (const fs::path& folder : listing->checkpoints) {
    uint32_t version = 0;
    if (!absl::SimpleAtoi(folder.filename().string(), &version)) continue;
    folders[folder.parent_path().filename().string()][version] = folder;
  }
  {
    common::MutexLock lock(mutex_);
    skipped_ = listing->skipped;
  }
  observer_.Scanned(listing->skipped);
  return folders;
}

absl::StatusOr<ReloadReport> ModelManager::Reload(const std::function<bool()>& stop) {
  common::MutexLock working(work_mutex_);
  ReloadReport report;
  if (!CheckRepository().ok()) {
    report.refused_labels = ApplyLabels();
    return report;
  }
  absl::StatusOr<Folders> folders = Scan();
  if (!folders.ok()) return folders.status();
  if (folders->empty()) {
    return absl::FailedPreconditionError("no model could be loaded: the repository is empty");
  }
  {
    // Includes models whose folders are gone.
    common::MutexLock lock(mutex_);
    for (const auto& [name, versions] : models_) (*folders)[name];
  }
  for (const auto& [name, versions] : *folders) {
    if (!ReloadModel(name, versions, stop, report)) {
      return absl::CancelledError("loading was stopped");
    }
  }
  return report;
}

bool ModelManager::ReloadModel(const std::string& name, const Folders::mapped_type& folders,
                               const std::function<bool()>& stop, ReloadReport& report) {
  Versions known = VersionsOf(name);
  for (const auto& [version, folder] : folders) {
    if (known[version].unloaded) continue;
    if (IsUnchanged(known[version], folder)) {
      ++report.unchanged;
    } else {
      if (stop()) return false;
      const bool loaded = LoadFolder(name, version, folder).ok();
      (loaded ? report.loaded : report.refused).push_back(SourceOf(name, version));
    }
  }
  // Moved first: a version without labels may be unloaded below.
  for (std::string& label : ApplyLabelsOf(name)) report.refused_labels.push_back(std::move(label));
  for (const auto& [version, state] : VersionsOf(name)) {
    if (!state.served || folders.count(version) > 0) continue;
    const std::string source = SourceOf(name, version);
    const absl::Status removed = Remove(name, version, /*by_operator=*/false);
    if (removed.ok()) {
      report.unloaded.push_back(source);
    } else {
      report.problems.push_back(absl::StrCat(source, " stays served: ", removed.message()));
    }
  }
  ForgetWithout(folders, name);
  return true;
}

void ModelManager::ForgetWithout(const Folders::mapped_type& folders, const std::string& name) {
  std::vector<std::string> forgotten;
  {
    common::MutexLock lock(mutex_);
    Versions& versions = models_[name];
    for (auto version = versions.begin(); version != versions.end();) {
      const auto& [number, known] = *version;
      const bool gone = folders.count(number) == 0 && !known.served;
      if (gone && !known.error.empty()) forgotten.push_back(SourceOf(name, number));
      version = gone ? versions.erase(version) : std::next(version);
    }
    if (versions.empty()) models_.erase(name);
  }
  for (const std::string& source : forgotten) observer_.Forgotten(source);
}

ModelManager::Versions ModelManager::VersionsOf(const std::string& name) const {
  common::MutexLock lock(mutex_);
  const auto model = models_.find(name);
  return model == models_.end() ? Versions() : model->second;
}

bool ModelManager::IsUnchanged(const Version& known, const fs::path& folder) {
  return known.served && known.error.empty() && !known.files.empty() &&
         known.files == FilesOf(folder);
}

absl::Status ModelManager::LoadFolder(const std::string& name, uint32_t version,
                                      const fs::path& folder) {
  ModelLoader loader;
  {
    common::MutexLock lock(mutex_);
    models_[name][version].loading = true;
    loader = loader_;
  }
  const std::string before = FilesOf(folder);
  const LoadReport report = LoadCheckpoint(folder, loader);
  // If the files changed meanwhile, it is unknown which of them were loaded: the next reload loads
  // them again.
  Take(name, version, report, FilesOf(folder) == before ? before : "");
  return report.model.status();
}

void ModelManager::Take(const std::string& name, uint32_t version, const LoadReport& report,
                        const std::string& files) {
  if (report.model.ok()) registry_.Serve(*report.model);
  bool served = false;
  {
    common::MutexLock lock(mutex_);
    Version& known = models_[name][version];
    known.loading = false;
    known.error = std::string(report.model.status().message());
    if (report.model.ok()) {
      known.served = true;
      known.files = files;
      known.load_seconds = report.load_seconds;
    }
    served = known.served;
  }
  observer_.Loaded(report, served);
}

absl::Status ModelManager::Remove(const std::string& name, uint32_t version, bool by_operator) {
  if (absl::Status status = registry_.Remove(name, version); !status.ok()) return status;
  {
    common::MutexLock lock(mutex_);
    Version& known = models_[name][version];
    known.served = false;
    known.error.clear();
    known.unloaded = by_operator;
  }
  observer_.Unloaded(SourceOf(name, version));
  return absl::OkStatus();
}

absl::Status ModelManager::Load(absl::string_view name, uint32_t version) {
  common::MutexLock working(work_mutex_);
  if (absl::Status status = CheckRepository(); !status.ok()) return status;
  const absl::StatusOr<Folders> folders = Scan();
  if (!folders.ok()) return folders.status();
  const auto model = folders->find(name);
  if (model == folders->end() || model->second.count(version) == 0) {
    return absl::NotFoundError(absl::StrCat("version ", version, " of model ", base::Quoted(name),
                                            " is not in the repository"));
  }
  const absl::Status loaded = LoadFolder(model->first, version, model->second.at(version));
  if (!loaded.ok()) {
    return absl::FailedPreconditionError(
        absl::StrCat(SourceOf(name, version), " cannot be loaded: ", loaded.message()));
  }
  common::MutexLock lock(mutex_);
  models_[model->first][version].unloaded = false;
  return absl::OkStatus();
}

absl::Status ModelManager::Unload(absl::string_view name, uint32_t version) {
  common::MutexLock working(work_mutex_);
  if (absl::Status status = CheckRepository(); !status.ok()) return status;
  return Remove(std::string(name), version, /*by_operator=*/true);
}

absl::Status ModelManager::CheckRepository() const {
  common::MutexLock lock(mutex_);
  if (!repository_.empty()) return absl::OkStatus();
  return absl::FailedPreconditionError(
      "model_repository: expected a folder, got none; the server serves its embedded models");
}

std::vector<ModelStatus> ModelManager::List() const {
  // The registry holds the labels and the default of the served models.
  std::map<std::pair<std::string, uint32_t>, ServedModel> served;
  for (ServedModel& model : registry_.List()) {
    const engine::ModelDescription& description = model.model->description();
    served[{description.name, static_cast<uint32_t>(description.version)}] = std::move(model);
  }
  common::MutexLock lock(mutex_);
  std::vector<ModelStatus> list;
  for (const auto& [name, versions] : models_) {
    for (const auto& [version, known] : versions) {
      ModelStatus status;
      status.name = name;
      status.version = version;
      status.state = known.served           ? ModelState::kServed
                     : known.loading        ? ModelState::kLoading
                     : !known.error.empty() ? ModelState::kFailed
                                            : ModelState::kUnloaded;
      status.error = known.error;
      status.outdated = known.served && !known.error.empty();
      status.load_seconds = known.load_seconds;
      if (const auto found = served.find({name, version}); found != served.end()) {
        status.version_labels = found->second.version_labels;
        status.is_default = found->second.is_default;
      }
      list.push_back(std::move(status));
    }
  }
  return list;
}

std::vector<SkippedFolder> ModelManager::skipped() const {
  common::MutexLock lock(mutex_);
  return skipped_;
}

std::vector<std::string> ModelManager::UnknownNames() const {
  common::MutexLock lock(mutex_);
  std::vector<std::string> names;
  for (const auto& [name, versions] : models_) names.push_back(name);
  std::vector<std::string> unknown;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    const std::string& model = labels_[i].model;
    if (std::find(names.begin(), names.end(), model) != names.end()) continue;
    unknown.push_back(absl::StrCat("version_labels[", i, "].model: expected one of: ",
                                   absl::StrJoin(names, ", "), ", got ", base::Quoted(model)));
  }
  return unknown;
}

void ModelControl::AddReloadable(Reloadable reloadable) {
  common::MutexLock lock(mutex_);
  entries_.push_back({std::move(reloadable), absl::OkStatus()});
}

std::vector<ModelControl::Entry> ModelControl::entries() const {
  common::MutexLock lock(mutex_);
  return entries_;
}

std::vector<std::string> ModelControl::problems() const {
  std::vector<std::string> problems;
  for (const Entry& entry : entries()) {
    const absl::Status state =
        entry.reloadable.state == nullptr ? entry.last : entry.reloadable.state();
    if (!state.ok()) problems.push_back(absl::StrCat(entry.reloadable.name, ": ", state.message()));
  }
  common::MutexLock lock(mutex_);
  if (!repository_.ok()) {
    problems.push_back(absl::StrCat("model repository: ", repository_.message()));
  }
  return problems;
}

void ModelControl::ReloadOthers() {
  // What is reloaded is not called under the lock.
  const std::vector<Entry> reloaded = entries();
  std::vector<absl::Status> outcomes;
  for (const Entry& entry : reloaded) outcomes.push_back(entry.reloadable.reload());
  common::MutexLock lock(mutex_);
  for (std::size_t i = 0; i < outcomes.size(); ++i) entries_[i].last = outcomes[i];
}

absl::StatusOr<ReloadReport> ModelControl::ReloadNow() {
  ReloadOthers();
  absl::StatusOr<ReloadReport> report = manager_.Reload([this] { return thread_.stopping(); });
  {
    common::MutexLock lock(mutex_);
    repository_ = report.status();
  }
  if (report.ok()) {
    std::vector<std::string> all = problems();
    for (std::string& unknown : manager_.UnknownNames()) all.push_back(std::move(unknown));
    report->problems.insert(report->problems.begin(), all.begin(), all.end());
  }
  observer_.Changed();
  observer_.Reloaded(report);
  return report;
}

void ModelControl::Reload(ReloadDone done) {
  thread_.Post([this, done = std::move(done)](bool run) {
    done(run ? ReloadNow() : absl::StatusOr<ReloadReport>(Stopping()));
  });
}

void ModelControl::Post(std::function<absl::Status()> work, Done done) {
  thread_.Post([this, work = std::move(work), done = std::move(done)](bool run) {
    const absl::Status status = run ? work() : Stopping();
    if (run) observer_.Changed();
    done(status);
  });
}

void ModelControl::Load(std::string name, uint32_t version, Done done) {
  Post([this, name = std::move(name), version] { return manager_.Load(name, version); },
       std::move(done));
}

void ModelControl::Unload(std::string name, uint32_t version, Done done) {
  Post([this, name = std::move(name), version] { return manager_.Unload(name, version); },
       std::move(done));
}

}  // namespace duet::server::registry
