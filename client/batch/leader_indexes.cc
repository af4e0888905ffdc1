#include "client/batch/leader_indexes.h"

#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;

// As many as above a sequence of SBU: sXXsYY/<class>/<sequence>/skeleton_pos.txt.
constexpr int kFoldersUp = 4;
constexpr size_t kMaxIndexBytes = size_t{64} << 20;

}  // namespace

absl::StatusOr<const LeaderIndexes::Entries*> LeaderIndexes::In(const fs::path& folder) {
  const auto known = indexes_.find(folder);
  if (known != indexes_.end()) return known->second.get();
  std::unique_ptr<const Entries>& index = indexes_[folder];
  const fs::path file = folder / "index.tsv";
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return nullptr;
  const absl::StatusOr<std::string> text = base::ReadFile(file, kMaxIndexBytes, "an index");
  if (!text.ok() || !dataset::LooksLikeIndex(*text)) return nullptr;
  absl::StatusOr<Entries> entries = dataset::ParseIndex(*text);
  if (!entries.ok()) {
    return absl::FailedPreconditionError(
        absl::StrCat(folder.string(), "/", entries.status().message()));
  }
  index = std::make_unique<const Entries>(*std::move(entries));
  return index.get();
}

absl::StatusOr<const dataset::IndexEntry*> LeaderIndexes::Find(const fs::path& file) {
  const fs::path whole = fs::absolute(file).lexically_normal();
  fs::path folder = whole;
  for (int i = 0; i < kFoldersUp && folder.has_relative_path(); ++i) {
    folder = folder.parent_path();
    const absl::StatusOr<const Entries*> entries = In(folder);
    if (!entries.ok()) return entries.status();
    if (*entries == nullptr) continue;
    const auto found = (*entries)->find(whole.lexically_relative(folder).generic_string());
    return found == (*entries)->end() ? nullptr : &found->second;
  }
  return nullptr;
}

}  // namespace duet::client::batch
