#include "client/batch/merge.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/batch/contact_sheet.h"
#include "client/batch/durable_file.h"
#include "client/batch/item_files.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/leader_digests.h"
#include "client/batch/made_by.h"
#include "client/batch/packing.h"
#include "client/batch/parse_record.h"
#include "client/batch/record.h"
#include "client/batch/setup.h"
#include "client/batch/verify.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr size_t kMissingKept = 100;
constexpr uint64_t kBytesOfACommit = uint64_t{64} << 20;

struct Part {
  std::shared_ptr<JobFolder> folder;
  std::shared_ptr<JournalReader> journal;
  std::shared_ptr<ItemReader> items;
};

// The identity of one of the shards; the others are checked against it.
absl::StatusOr<JobIdentity> FindIdentity(const fs::path& out) {
  std::error_code error;
  std::vector<fs::path> folders;
  for (fs::directory_iterator it(out, error), end; !error && it != end; it.increment(error)) {
    if (absl::StartsWith(it->path().filename().string(), "shard-")) folders.push_back(it->path());
  }
  std::sort(folders.begin(), folders.end());
  for (const fs::path& folder : folders) {
    absl::StatusOr<JobIdentity> identity = ReadJobIdentity(folder);
    if (identity.ok()) return identity;
  }
  return absl::NotFoundError(absl::StrCat(
      out.string(), ": expected folders shard-INDEX-of-COUNT of duet batch, got none"));
}

bool SameModels(const JobIdentity& a, const JobIdentity& b) {
  if (!GoOn(a, b).ok()) return false;  // different weights
  return std::equal(a.models.begin(), a.models.end(), b.models.begin(), b.models.end(),
                    [](const ModelChoice& one, const ModelChoice& other) {
                      return one.name == other.name && one.version == other.version;
                    });
}

absl::StatusOr<Part> OpenPart(const fs::path& out, const JobIdentity& identity, int index,
                              int64_t* planned) {
  const Shard shard{index, identity.shard.count};
  const fs::path path = ShardFolder(out, shard);
  const absl::StatusOr<PlannedItems> items = ReadPlanned(path);
  if (!items.ok() || !items->whole) {
    return absl::AbortedError(absl::StrCat(path.string(), ": expected all ", shard.count,
                                           " shards, complete; this one is missing or incomplete"));
  }
  *planned += items->count;
  Part part;
  part.folder = std::make_shared<JobFolder>(path);
  JobIdentity wanted = identity;
  wanted.shard = shard;
  JobIdentity begun;
  absl::Status status = part.folder->Open(wanted, &begun);
  if (!status.ok()) return status;
  if (!SameModels(begun, identity)) {
    return absl::FailedPreconditionError(
        absl::StrCat(path.string(), ": expected the models of the other shards, got others"));
  }
  if (begun.up != identity.up) {
    return absl::FailedPreconditionError(
        absl::StrCat(path.string(),
                     ": expected the vertical of the other shards (input.level), got "
                     "another: their leaders differ"));
  }
  if (begun.seed_rule != identity.seed_rule) {
    return absl::FailedPreconditionError(absl::StrCat(
        path.string(),
        ": expected seeds as of the other shards, got those of another version of duet batch"));
  }
  absl::StatusOr<JournalReader> journal = JournalReader::Open(part.folder->journal());
  if (!journal.ok()) return journal.status();
  part.journal = std::make_shared<JournalReader>(*std::move(journal));
  part.items =
      std::make_shared<ItemReader>(part.folder->items(identity.packing), part.folder->spool());
  return part;
}

// Moves an item's files. A merge that was stopped may have moved some of them.
absl::Status MoveFile(const fs::path& from, const fs::path& to, const std::string& sha256) {
  absl::Status status = CheckFile(from, sha256);
  if (absl::IsNotFound(status)) return CheckFile(to, sha256);
  if (!status.ok()) return status;
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  fs::rename(from, to, error);
  return error ? CannotWrite(to, error.value()) : absl::OkStatus();
}

// Whether everything is merged and only the folders of shards may be left.
bool IsMerged(const fs::path& out) {
  const absl::StatusOr<JobIdentity> identity = ReadJobIdentity(out);
  const absl::StatusOr<PlannedItems> planned = ReadPlanned(out);
  return identity.ok() && planned.ok() && planned->whole && planned->missing == 0;
}

absl::Status RemoveShards(const fs::path& out, int count) {
  for (int i = 0; i < count; ++i) {
    std::error_code error;
    fs::remove_all(ShardFolder(out, {i, count}), error);
    if (error) return CannotWrite(out, error.value());
  }
  return absl::OkStatus();
}

class Merger {
 public:
  Merger(const fs::path& out, JobIdentity identity)
      : folder_(out), identity_(std::move(identity)) {}

  absl::Status Open() {
    const int count = identity_.shard.count;
    for (int i = 0; i < count; ++i) {
      absl::StatusOr<Part> part = OpenPart(folder_.out(), identity_, i, &planned_);
      if (!part.ok()) return part.status();
      parts_.push_back(*std::move(part));
    }
    identity_.shard = Shard{};
    JobIdentity begun;
    return folder_.Open(identity_, &begun);
  }

  // Continues a merge that was stopped: items in the merged journal have been moved.
  absl::Status MoveAll() {
    absl::Status status = RepairJournal(folder_.journal(), folder_.temporary() / "journal");
    if (!status.ok()) return status;
    const absl::StatusOr<JournalReader> merged = JournalReader::Open(folder_.journal());
    if (!merged.ok()) return merged.status();
    status = journal_.Open(folder_.journal(), merged->size());
    writer_ = MakeItemWriter(folder_, identity_.packing);
    int64_t end = 0;
    for (const Part& part : parts_) end = std::max(end, part.journal->end());
    for (int64_t item = 0; status.ok() && item < end; ++item) {
      status = MoveItem(item, *merged);
      if (status.ok() && uncommitted_ >= kBytesOfACommit) status = Commit();
    }
    if (status.ok()) status = Commit();
    return status.ok() ? folder_.Begin(identity_) : status;
  }

  absl::StatusOr<MergeReport> Finish() {
    const absl::StatusOr<JournalReader> journal = JournalReader::Open(folder_.journal());
    if (!journal.ok()) return journal.status();
    absl::StatusOr<ShardList> shards = OpenShards(*journal, identity_, folder_);
    absl::Status status = shards.status();
    if (status.ok() && shards->empty()) {
      status = WriteContactSheet(*journal, identity_,
                                 ItemReader(folder_.items(identity_.packing), folder_.spool()),
                                 folder_.out());
    }
    if (status.ok() && identity_.packing != Packing::kNone && journal->count() == planned_) {
      status = Pack(*journal, identity_, folder_);
      if (status.ok()) shards = OpenShards(*journal, identity_, folder_);
    }
    if (!status.ok()) return status;
    if (!shards.ok()) return shards.status();
    WrittenSetFiles files(folder_.temporary(), folder_.out());
    absl::StatusOr<SetCounts> counts =
        WriteIndex(*journal, identity_, *shards, {planned_, true}, &files);
    if (!counts.ok()) return counts.status();
    report_.set = *counts;
    report_.planned = planned_;
    // Missing items can still be made in their shard and merged again.
    if (journal->count() < planned_) return report_;
    status = RemoveShards(folder_.out(), static_cast<int>(parts_.size()));
    if (!status.ok()) return status;
    return report_;
  }

 private:
  absl::Status MoveItem(int64_t item, const JournalReader& merged) {
    const auto part = std::find_if(parts_.begin(), parts_.end(), [item](const Part& candidate) {
      return candidate.journal->Has(item);
    });
    if (part == parts_.end()) {
      if (report_.missing.size() < kMissingKept) report_.missing.push_back(item);
      return absl::OkStatus();
    }
    const absl::StatusOr<JournalEntry> entry = part->journal->Read(item);
    if (!entry.ok()) return entry.status();
    const absl::StatusOr<ordered_json> parsed = ParseRecord(entry->record);
    if (!parsed.ok()) return parsed.status();
    const ordered_json& record = *parsed;
    absl::Status status = leaders_.CheckRecord(record);
    if (status.ok()) status = makers_.CheckRecord(record);
    if (!status.ok()) return status;
    if (merged.Has(item)) {
      const absl::StatusOr<JournalEntry> moved = merged.Read(item);
      if (moved.ok() && moved->record == entry->record) return absl::OkStatus();
    }
    if (record["state"] == kDone && identity_.packing != Packing::kNone) {
      return CopyToSpool(*part, *entry, record);
    }
    journal_.Add(item, entry->record);
    return record["state"] == kDone ? MoveFiles(*part, record) : absl::OkStatus();
  }

  absl::Status MoveFiles(const Part& part, const ordered_json& record) {
    for (const ordered_json& file : record["files"]) {
      const std::string path = file["path"];
      const fs::path to = folder_.items(identity_.packing) / path;
      folders_.insert(to.parent_path());
      absl::Status status =
          MoveFile(part.folder->items(identity_.packing) / path, to, file["sha256"]);
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status CopyToSpool(const Part& part, const JournalEntry& entry,
                           const ordered_json& record) {
    std::vector<ItemFile> files;
    for (size_t i = 0; i < record["files"].size(); ++i) {
      absl::StatusOr<std::string> content = part.items->Read(record, entry.place, i);
      if (!content.ok()) return content.status();
      uncommitted_ += content->size();
      files.push_back({record["files"][i]["path"], *std::move(content)});
    }
    const absl::StatusOr<SpoolPlace> place = writer_->Add(files);
    if (!place.ok()) return place.status();
    part.items->Forget(record, entry.place);
    journal_.Add(entry.item, entry.record, *place);
    return absl::OkStatus();
  }

  // Removes files from the old place only after they are on disk in the new one.
  absl::Status Commit() {
    absl::Status status = writer_->Commit();
    for (const fs::path& folder : folders_) status.Update(SyncFolder(folder));
    if (status.ok()) status = journal_.Commit();
    for (const Part& part : parts_) {
      if (status.ok()) part.items->Release();
    }
    folders_.clear();
    uncommitted_ = 0;
    return status;
  }

  JobFolder folder_;
  JobIdentity identity_;
  std::vector<Part> parts_;
  JournalWriter journal_;
  std::unique_ptr<ItemWriter> writer_;
  LeaderDigests leaders_;
  Makers makers_;
  std::set<fs::path> folders_;
  uint64_t uncommitted_ = 0;  // bytes
  int64_t planned_ = 0;
  MergeReport report_;
};

}  // namespace

absl::StatusOr<MergeReport> Merge(const fs::path& out) {
  absl::StatusOr<JobIdentity> identity = FindIdentity(out);
  if (!identity.ok()) return identity.status();
  if (IsMerged(out)) {
    const PlannedItems planned = *ReadPlanned(out);
    absl::Status removed = RemoveShards(out, identity->shard.count);
    if (!removed.ok()) return removed;
    return MergeReport{{}, planned.count, {}};
  }
  Merger merger(out, *std::move(identity));
  absl::Status status = merger.Open();
  if (status.ok()) status = merger.MoveAll();
  if (!status.ok()) return status;
  return merger.Finish();
}

}  // namespace duet::client::batch
