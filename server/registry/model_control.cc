#include "server/registry/model_control.h"

#include <utility>

#include "absl/strings/str_cat.h"

namespace duet::server::registry {
namespace {

absl::Status Stopping() { return absl::CancelledError("the server is stopping"); }

}  // namespace

absl::StatusOr<ReloadReport> ModelControl::ReloadNow() {
  std::vector<std::string> problems;
  for (const Reloadable& reloadable : reloadables_) {
    const absl::Status reloaded = reloadable.reload();
    if (!reloaded.ok()) {
      problems.push_back(absl::StrCat(reloadable.name, ": ", reloaded.message()));
    }
  }
  absl::StatusOr<ReloadReport> report = manager_.Reload([this] { return thread_.stopping(); });
  if (report.ok()) {
    report->problems.insert(report->problems.begin(), problems.begin(), problems.end());
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
