#include "server/registry/model_repository.h"

#include <algorithm>
#include <cstdint>
#include <system_error>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "server/common/clock.h"

namespace duet::server::registry {
namespace {

namespace fs = std::filesystem;

bool IsVersion(const std::string& text) {
  int32_t version{};
  return absl::SimpleAtoi(text, &version) && version >= 1 && absl::StrCat(version) == text;
}

// The folders inside a folder.
absl::StatusOr<std::vector<fs::path>> Subfolders(const fs::path& folder) {
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  std::vector<fs::path> folders;
  while (!error && entries != fs::directory_iterator()) {
    std::error_code ignored;
    if (entries->is_directory(ignored)) folders.push_back(entries->path());
    entries.increment(error);
  }
  if (!error) return folders;
  const std::string message =
      absl::StrCat("cannot read the folder ", folder.string(), ": ", error.message());
  if (error == std::errc::permission_denied) return absl::PermissionDeniedError(message);
  return absl::NotFoundError(message);
}

absl::Status CheckPlace(const fs::path& folder, const engine::ModelDescription& model) {
  const std::string name = folder.parent_path().filename().string();
  const std::string version = folder.filename().string();
  if (model.name == name && absl::StrCat(model.version) == version) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("the manifest says model ", model.name,
                                                 " version ", model.version, ", its folder says ",
                                                 name, " version ", version));
}

}  // namespace

absl::StatusOr<RepositoryListing> ListCheckpoints(const fs::path& repository) {
  absl::StatusOr<std::vector<fs::path>> names = Subfolders(repository);
  if (!names.ok()) return names.status();
  RepositoryListing listing;
  for (const fs::path& name : *names) {
    absl::StatusOr<std::vector<fs::path>> versions = Subfolders(name);
    // A volume's own folders (lost+found) may well be closed to us.
    if (!versions.ok()) {
      listing.unreadable.push_back(versions.status());
      continue;
    }
    for (fs::path& version : *versions) {
      std::error_code ignored;
      if (!IsVersion(version.filename().string())) continue;
      if (!fs::exists(version / "manifest.json", ignored)) continue;
      listing.checkpoints.push_back(std::move(version));
    }
  }
  std::sort(listing.checkpoints.begin(), listing.checkpoints.end());
  return listing;
}

LoadReport LoadCheckpoint(const fs::path& folder, const ModelLoader& loader) {
  const common::TimePoint begin = common::Clock::Real().Now();
  LoadReport report{(folder.parent_path().filename() / folder.filename()).string(), loader(folder),
                    0};
  report.load_seconds = common::SecondsBetween(begin, common::Clock::Real().Now());
  if (report.model.ok()) {
    const absl::Status placed = CheckPlace(folder, (*report.model)->description());
    if (!placed.ok()) report.model = placed;
  }
  return report;
}

}  // namespace duet::server::registry
