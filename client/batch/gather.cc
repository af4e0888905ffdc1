#include "client/batch/gather.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/batch/durable_file.h"
#include "client/batch/journal.h"
#include "client/batch/record.h"
#include "client/batch/text_values.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> ShardFolders(const fs::path& out) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator it(out, error), end; !error && it != end; it.increment(error)) {
    const bool named = absl::StartsWith(it->path().filename().string(), "shard-");
    if (named && ReadJobIdentity(it->path()).ok()) folders.push_back(it->path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

absl::Status CheckSameJob(const fs::path& shard, const JobIdentity& first,
                          const JobIdentity& other) {
  const bool same_models = std::equal(
      first.models.begin(), first.models.end(), other.models.begin(), other.models.end(),
      [](const JobIdentity::Model& a, const JobIdentity::Model& b) {
        return ModelText(a.choice) == ModelText(b.choice) && a.weights_sha256 == b.weights_sha256;
      });
  if (same_models) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat(
      shard.string(), ": expected the models and weights of the other items, got others"));
}

// Moves the files of an item. A run that was stopped may have moved some of them.
absl::Status MoveFiles(const fs::path& from, const fs::path& to, const v1::IndexEntry& record) {
  for (const v1::IndexEntry::File& file : record.files()) {
    std::error_code error;
    if (!fs::exists(from / file.path(), error)) continue;
    absl::Status status = RenameInto((from / file.path()).string(), (to / file.path()).string());
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status Take(const JobFolder& shard, const JobFolder& folder, int64_t* items) {
  const absl::StatusOr<JournalReader> made = JournalReader::Open(shard.journal());
  if (!made.ok()) return made.status();
  const absl::StatusOr<JournalReader> known = JournalReader::Open(folder.journal());
  if (!known.ok()) return known.status();
  JournalWriter journal;
  absl::Status status = journal.Open(folder.journal(), known->size());
  if (!status.ok()) return status;
  status = made->ForEach([&](const JournalEntry& entry) {
    const absl::StatusOr<v1::IndexEntry> record = ParseRecord(entry.record);
    if (!record.ok()) return absl::OkStatus();  // the run requests it again
    journal.Add(entry.item, entry.record);
    ++*items;
    return MoveFiles(shard.out(), folder.out(), *record);
  });
  // Files before records, so that a record never names a missing file.
  if (status.ok()) status = SyncFileSystem(folder.out());
  return status.ok() ? journal.Commit() : status;
}

}  // namespace

absl::StatusOr<Gathered> GatherShards(const JobIdentity& wanted, const JobFolder& folder,
                                      JobIdentity* begun) {
  Gathered gathered;
  for (const fs::path& path : ShardFolders(folder.out())) {
    const absl::StatusOr<JobIdentity> identity = ReadJobIdentity(path);
    if (!identity.ok()) return identity.status();
    JobIdentity wanted_shard = wanted, begun_shard;
    wanted_shard.shard = identity->shard;
    JobFolder shard(path);
    absl::Status status = shard.Open(wanted_shard, &begun_shard);
    if (!status.ok()) return status;
    if (begun_shard.models.empty()) continue;  // discarded, because it has no answers
    begun_shard.shard = wanted.shard;
    if (begun->models.empty()) {
      *begun = begun_shard;
      status = folder.Begin(*begun);
    } else {
      status = CheckSameJob(path, *begun, begun_shard);
    }
    if (status.ok()) status = Take(shard, folder, &gathered.items);
    if (!status.ok()) return status;
    // At once, so that no part of the folder is left if the run is stopped.
    const fs::path unneeded = folder.temporary() / path.filename();
    std::error_code error;
    fs::rename(path, unneeded, error);
    if (error) return CannotWrite(path, error.value());
    fs::remove_all(unneeded, error);
    ++gathered.shards;
    gathered.count = identity->shard.count;
  }
  return gathered;
}

}  // namespace duet::client::batch
