#include "server/registry/model_repository.h"

#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <system_error>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/common/clock.h"
#include "server/registry/golden_check.h"

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
  return absl::InvalidArgumentError(absl::StrCat("manifest: expected model ", name, " version ",
                                                 version, " as in the folder, got ", model.name,
                                                 " version ", model.version));
}

bool IsHidden(const fs::path& path) { return absl::StartsWith(path.filename().string(), "."); }

// A volume's folder whose content changes all at once lies behind this link.
constexpr char kVolumeData[] = "..data";

constexpr char kManifest[] = "manifest.json";

// Looks through one model's folder.
void ListVersions(const fs::path& name, RepositoryListing& listing) {
  const std::string model = name.filename().string();
  absl::StatusOr<std::vector<fs::path>> versions = Subfolders(name);
  // A volume's own folders (lost+found) may well be closed to us.
  if (!versions.ok()) {
    listing.skipped.push_back({model, std::string(versions.status().message())});
    return;
  }
  bool has_versions = false;
  for (fs::path& version : *versions) {
    if (IsHidden(version)) continue;
    has_versions = true;
    const std::string folder = absl::StrCat(model, "/", version.filename().string());
    std::error_code ignored;
    if (!IsVersion(version.filename().string())) {
      listing.skipped.push_back(
          {folder, "expected a version of at least 1 without leading zeros as the folder's name"});
    } else if (!fs::exists(ResolveCheckpoint(version) / kManifest, ignored)) {
      listing.skipped.push_back({folder, "expected a manifest.json, got none"});
    } else {
      listing.checkpoints.push_back(std::move(version));
    }
  }
  if (!has_versions) {
    listing.skipped.push_back({model, "has no folder of a version, such as 1"});
  }
}

}  // namespace

absl::StatusOr<RepositoryListing> ListCheckpoints(const fs::path& repository) {
  absl::StatusOr<std::vector<fs::path>> names = Subfolders(repository);
  if (!names.ok()) return names.status();
  RepositoryListing listing;
  for (const fs::path& name : *names) {
    if (!IsHidden(name)) ListVersions(name, listing);
  }
  std::sort(listing.checkpoints.begin(), listing.checkpoints.end());
  std::sort(listing.skipped.begin(), listing.skipped.end(),
            [](const auto& a, const auto& b) { return a.folder < b.folder; });
  return listing;
}

fs::path ResolveCheckpoint(const fs::path& folder) {
  std::error_code error;
  fs::path resolved = fs::canonical(folder / kVolumeData, error);
  if (error) resolved = fs::canonical(folder, error);
  return error ? folder : resolved;
}

std::string FilesOf(const fs::path& folder) {
  std::set<std::string> files;
  std::error_code error;
  for (fs::directory_iterator entry(ResolveCheckpoint(folder), error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    struct stat file = {};
    if (IsHidden(name) || absl::EndsWith(name, ".md")) continue;
    if (stat(entry->path().c_str(), &file) != 0 || !S_ISREG(file.st_mode)) continue;
    // Programs cannot set the change time (ctim), so it differs even if the others were restored.
    files.insert(absl::StrCat(name, " ", file.st_dev, ":", file.st_ino, ":", file.st_size, ":",
                              file.st_mtim.tv_sec, ".", file.st_mtim.tv_nsec, ":",
                              file.st_ctim.tv_sec, ".", file.st_ctim.tv_nsec));
  }
  return absl::StrJoin(files, "\n");
}

LoadReport LoadCheckpoint(const fs::path& folder, const ModelLoader& loader) {
  const common::TimePoint begin = common::Clock::Real().Now();
  LoadReport report{(folder.parent_path().filename() / folder.filename()).string(),
                    loader(ResolveCheckpoint(folder)), 0};
  if (report.model.ok()) {
    absl::Status checked = CheckPlace(folder, (*report.model)->description());
    if (checked.ok()) checked = CheckAnswers(**report.model);
    if (!checked.ok()) report.model = checked;
  }
  report.load_seconds = common::SecondsBetween(begin, common::Clock::Real().Now());
  return report;
}

}  // namespace duet::server::registry
