#include "client/batch/packing.h"

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/batch/archive.h"
#include "client/batch/damage.h"
#include "client/batch/durable_file.h"
#include "client/batch/item_files.h"
#include "client/batch/parse_record.h"
#include "client/batch/record.h"
#include "model/base/sha256.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

bool IsDone(const ordered_json& record) { return record["state"] == kDone; }

// An item of a shard: its record, and the place of its files outside the shard, if any.
struct DoneItem {
  int64_t item = 0;
  SpoolPlace place;
  ordered_json record;
};

// The item's record; nullopt if the item is not done.
absl::StatusOr<std::optional<DoneItem>> ReadDone(const JournalReader& journal, int64_t item) {
  if (!journal.Has(item)) return std::optional<DoneItem>();
  const absl::StatusOr<JournalEntry> entry = journal.Read(item);
  if (!entry.ok()) return entry.status();
  absl::StatusOr<ordered_json> record = ParseRecord(entry->record);
  if (!record.ok()) return record.status();
  if (!IsDone(*record)) return std::optional<DoneItem>();
  return std::optional<DoneItem>(DoneItem{item, entry->place, *std::move(record)});
}

// Reads an existing shard, member by member in the order of its items.
class OldShard {
 public:
  explicit OldShard(const fs::path& file) : reader_(file) {}

  // The content of an item's file, searched after the previous one. nullopt if it is missing or
  // differs from its record.
  std::optional<std::string> Find(const ordered_json& file) {
    if (ended_) return std::nullopt;
    absl::StatusOr<std::optional<ArchiveMember>> member = reader_.Find(file["path"]);
    ended_ = !member.ok() || !member->has_value();
    if (ended_ || base::Sha256Hex((*member)->content) != file["sha256"]) return std::nullopt;
    return std::move((*member)->content);
  }

 private:
  ArchiveReader reader_;
  bool ended_ = false;
};

uint64_t BytesOf(const ordered_json& record) {
  uint64_t bytes = 0;
  for (const ordered_json& file : record["files"]) bytes += file["bytes"].get<uint64_t>();
  return bytes;
}

// All done items that are not in a shard.
absl::Status AddRest(const JournalReader& journal, const JobIdentity& identity, ShardList* list) {
  // A copy, because items are added below.
  const ShardList known = *list;
  return journal.ForEach([&](const JournalEntry& entry) {
    if (known.ShardOf(entry.item) != ShardList::kNone) return absl::OkStatus();
    const absl::StatusOr<ordered_json> record = ParseRecord(entry.record);
    if (record.ok() && IsDone(*record)) {
      list->Add(entry.item, BytesOf(*record), identity.shard_bytes,
                SplitOfRecord(identity.description.splits, *record));
    }
    return record.status();
  });
}

// Writes the shards of a list that are missing or damaged.
class Packer {
 public:
  Packer(const JournalReader& journal, const JobIdentity& identity, const JobFolder& folder,
         ShardList list)
      : journal_(journal),
        packing_(identity.packing),
        folder_(folder),
        list_(std::move(list)),
        items_(folder.items(identity.packing), folder.spool()),
        damage_(ReadDamage(folder.damage())) {}

  absl::Status PackAll() {
    absl::Status status = list_.Commit();
    for (size_t number = 0; status.ok() && number < list_.shards().size(); ++number) {
      status = PackOne(number);
    }
    if (!bad_.empty()) {
      damage_.items.insert(bad_.begin(), bad_.end());
      (void)WriteDamage(damage_, folder_.damage());
      return absl::AbortedError(absl::StrCat(folder_.out().string(), ": ", bad_.size(),
                                             " items waiting to be packed are damaged. Run the "
                                             "same command again to request them again"));
    }
    return status;
  }

 private:
  absl::Status PackOne(size_t number) {
    const PackedShard& shard = list_.shards()[number];
    if (shard.items.empty()) return absl::OkStatus();
    const fs::path file = folder_.out() / list_.NameOf(number, packing_);
    if (LooksWhole(shard, file) && !IsDamaged(shard, file)) {
      // The run was stopped between the shard and the list, or an earlier version wrote no list.
      if (!shard.sha256.empty()) return absl::OkStatus();
      const absl::StatusOr<std::set<int64_t>> bad = FindBadItems(journal_, shard, file);
      if (!bad.ok()) return bad.status();
      if (bad->empty()) return Settle(number, shard.items, file);
    }
    return Write(number, file);
  }

  bool IsDamaged(const PackedShard& shard, const fs::path& file) const {
    if (damage_.shards.count(file.filename().string()) > 0) return true;
    for (const auto& [first, last] : shard.items) {
      const auto found = damage_.items.lower_bound(first);
      if (found != damage_.items.end() && *found <= last) return true;
    }
    return false;
  }

  absl::Status Write(size_t number, const fs::path& path) {
    DurableFile file(folder_.temporary() / path.filename());
    absl::Status status = file.Open();
    if (!status.ok()) return status;
    const std::unique_ptr<Archive> archive = MakeArchive(packing_, &file);
    OldShard old(path);
    std::vector<std::pair<int64_t, int64_t>> items;
    const size_t bad_before = bad_.size();
    for (const auto& [first, last] : list_.shards()[number].items) {
      for (int64_t item = first; item <= last; ++item) {
        const absl::StatusOr<std::optional<DoneItem>> done = ReadDone(journal_, item);
        if (!done.ok()) return done.status();
        // An item that failed when it was requested again is no longer in a shard.
        if (!done->has_value()) continue;
        status = AddItem(**done, &old, archive.get());
        if (!status.ok()) return status;
        if (items.empty() || items.back().second + 1 != item) items.emplace_back(item, item);
        items.back().second = item;
      }
    }
    if (bad_.size() > bad_before) {
      items_.Keep();
      return absl::OkStatus();  // the other shards are written
    }
    if (items.empty()) return Remove(number, path);
    status = archive->Finish();
    if (status.ok()) status = file.Finish(path);
    if (status.ok()) status = Settle(number, std::move(items), path);
    if (status.ok()) items_.Release();
    return status;
  }

  absl::Status AddItem(const DoneItem& done, OldShard* old, Archive* archive) {
    bool unpacked = true;
    for (size_t i = 0; i < done.record["files"].size(); ++i) {
      const ordered_json& recorded = done.record["files"][i];
      absl::StatusOr<std::string> content = items_.Read(done.record, done.place, i);
      if (!content.ok()) {
        unpacked = false;
        std::optional<std::string> packed = old->Find(recorded);
        if (!packed.has_value()) {
          bad_.insert(done.item);
          return absl::OkStatus();
        }
        content = *std::move(packed);
      }
      absl::Status status = archive->Add(recorded["path"], *content);
      if (!status.ok()) return status;
    }
    // The place of an item that was packed earlier may now belong to another item.
    if (unpacked) items_.Forget(done.record, done.place);
    return archive->AddRecord(done.record["name"], Line(done.record) + "\n");
  }

  absl::Status Settle(size_t number, std::vector<std::pair<int64_t, int64_t>> items,
                      const fs::path& file) {
    absl::StatusOr<std::string> digest = base::Sha256HexOfFile(file);
    if (!digest.ok()) return digest.status();
    std::error_code error;
    list_.Set(number, {std::move(items), fs::file_size(file, error), *std::move(digest),
                       list_.shards()[number].split});
    return list_.Commit();
  }

  absl::Status Remove(size_t number, const fs::path& path) {
    std::error_code error;
    fs::remove(path, error);
    list_.Set(number, {});
    return list_.Commit();
  }

  const JournalReader& journal_;
  const Packing packing_;
  const JobFolder& folder_;
  ShardList list_;
  ItemReader items_;
  Damage damage_;
  std::set<int64_t> bad_;
};

}  // namespace

absl::StatusOr<ShardList> OpenShards(const JournalReader& journal, const JobIdentity& identity,
                                     const JobFolder& folder) {
  absl::StatusOr<ShardList> list = ShardList::Open(folder.shards());
  std::error_code error;
  if (!list.ok() || !list->empty() || identity.packing == Packing::kNone ||
      !fs::exists(folder.out() / ShardName(identity.packing, 0), error)) {
    return list;
  }
  absl::Status status = AddRest(journal, identity, &*list);
  if (!status.ok()) return status;
  list->Reindex();
  return list;
}

bool LooksWhole(const PackedShard& shard, const fs::path& file) {
  std::error_code error;
  const uint64_t bytes = fs::file_size(file, error);
  return !error && (shard.sha256.empty() || bytes == shard.bytes);
}

absl::StatusOr<std::set<int64_t>> FindBadItems(const JournalReader& journal,
                                               const PackedShard& shard, const fs::path& file) {
  std::set<int64_t> bad;
  OldShard packed(file);
  for (const auto& [first, last] : shard.items) {
    for (int64_t item = first; item <= last; ++item) {
      const absl::StatusOr<std::optional<DoneItem>> done = ReadDone(journal, item);
      if (!done.ok()) return done.status();
      if (!done->has_value()) continue;
      for (const ordered_json& recorded : (*done)->record["files"]) {
        if (!packed.Find(recorded).has_value()) bad.insert(item);
      }
    }
  }
  return bad;
}

absl::Status Pack(const JournalReader& journal, const JobIdentity& identity,
                  const JobFolder& folder) {
  absl::StatusOr<ShardList> list = OpenShards(journal, identity, folder);
  if (!list.ok()) return list.status();
  absl::Status status = AddRest(journal, identity, &*list);
  if (status.ok()) status = Packer(journal, identity, folder, *std::move(list)).PackAll();
  std::error_code error;
  if (status.ok()) fs::remove_all(folder.items(identity.packing), error);
  if (status.ok()) fs::remove(folder.spool(), error);
  return status;
}

}  // namespace duet::client::batch
