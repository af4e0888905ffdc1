#include "server/registry/checkpoint_fingerprint.h"

#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <system_error>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/sha256.h"
#include "server/registry/model_repository.h"

namespace duet::server::registry {
namespace {

namespace fs = std::filesystem;

// Programs cannot set the change time, so it differs even if a file's size and modification time
// were restored.
std::string StampOf(const struct stat& file) {
  return absl::StrJoin(
      {static_cast<int64_t>(file.st_dev), static_cast<int64_t>(file.st_ino),
       static_cast<int64_t>(file.st_size), static_cast<int64_t>(file.st_mtim.tv_sec),
       static_cast<int64_t>(file.st_mtim.tv_nsec), static_cast<int64_t>(file.st_ctim.tv_sec),
       static_cast<int64_t>(file.st_ctim.tv_nsec)},
      ":");
}

// Far more than the time resolution of any file system.
constexpr std::chrono::seconds kSettling(2);

bool IsSettled(const struct stat& file, CheckpointFingerprint::Time now) {
  const auto seconds = std::chrono::seconds(std::max(file.st_mtim.tv_sec, file.st_ctim.tv_sec));
  return CheckpointFingerprint::Time(seconds) + kSettling < now;
}

std::string DigestOf(const fs::path& path, const CheckpointFingerprint::Stop& stop) {
  return base::Sha256HexOfFile(path, stop).value_or(std::string());
}

}  // namespace

CheckpointFingerprint::Files CheckpointFingerprint::List(const fs::path& folder, Time now) {
  Files files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (absl::StartsWith(name, ".") || absl::EndsWith(name, ".md")) continue;
    struct stat file = {};
    if (stat(entry->path().c_str(), &file) != 0 || !S_ISREG(file.st_mode)) continue;
    files[name] = {StampOf(file), IsSettled(file, now), file.st_size, ""};
  }
  return files;
}

CheckpointFingerprint CheckpointFingerprint::Of(const fs::path& folder, Time now) {
  CheckpointFingerprint fingerprint;
  fingerprint.files_ = List(ResolveCheckpoint(folder), now);
  return fingerprint;
}

void CheckpointFingerprint::ReadContent(const fs::path& folder, const Stop& stop) {
  const fs::path resolved = ResolveCheckpoint(folder);
  for (auto& [name, file] : files_) file.digest = DigestOf(resolved / name, stop);
}

bool CheckpointFingerprint::HasSizesOf(const Files& found) const {
  return std::equal(found.begin(), found.end(), files_.begin(), files_.end(),
                    [](const auto& a, const auto& b) {
                      return a.first == b.first && a.second.bytes == b.second.bytes;
                    });
}

bool CheckpointFingerprint::Matches(const fs::path& folder, Time now, const Stop& stop) {
  const fs::path resolved = ResolveCheckpoint(folder);
  Files found = List(resolved, now);
  // Before any file is read.
  if (files_.empty() || !HasSizesOf(found)) return false;
  for (auto& [name, file] : found) {
    const File& before = files_.at(name);
    if (before.digest.empty()) return false;
    const bool untouched = before.settled && file.stamp == before.stamp;
    file.digest = untouched ? before.digest : DigestOf(resolved / name, stop);
    if (file.digest != before.digest) return false;
  }
  files_ = std::move(found);
  return true;
}

bool CheckpointFingerprint::IsUntouched(const fs::path& folder) const {
  const Files found = List(ResolveCheckpoint(folder), Time());
  return std::equal(found.begin(), found.end(), files_.begin(), files_.end(),
                    [](const auto& a, const auto& b) {
                      return a.first == b.first && a.second.stamp == b.second.stamp;
                    });
}

}  // namespace duet::server::registry
