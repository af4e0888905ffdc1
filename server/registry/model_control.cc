#include "server/registry/model_control.h"

#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"

namespace duet::server::registry {
namespace {

absl::Status Stopping() { return absl::CancelledError("the server is stopping"); }

}  // namespace

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

absl::Status ModelControl::SetLabel(const std::string& name, const std::string& label,
                                    uint32_t version) {
  return registry_.SetLabel(name, label, version);
}

absl::Status ModelControl::DeleteLabel(const std::string& name, const std::string& label) {
  return registry_.DeleteLabel(name, label);
}

}  // namespace duet::server::registry
