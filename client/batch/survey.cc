#include "client/batch/survey.h"

#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/batch/packing.h"
#include "client/batch/parse_record.h"
#include "client/batch/record.h"
#include "client/batch/text_values.h"
#include "model/base/strict_json.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// The fields in which an item differs from its record, each as 'labels: expected ..., got ...'.
std::string DescribeChange(const ordered_json& record, const Item& item,
                           const JobIdentity& identity) {
  ordered_json now = FailedRecord(item, absl::OkStatus());
  now["model"] = ModelText(identity.models[static_cast<size_t>(item.model)]);
  std::vector<std::string> changes;
  const auto shown = [](const ordered_json& of, const char* field) {
    return of.contains(field) ? base::Shown(nlohmann::json(of[field])) : std::string("none");
  };
  for (const char* field : {"leader", "side", "group", "reaction", "labels", "model", "name"}) {
    // The record of a failed item has no model.
    if (!record.contains(field) && field == std::string("model")) continue;
    const std::string was = shown(record, field), is = shown(now, field);
    if (was != is) changes.push_back(absl::StrCat(field, ": expected ", was, ", got ", is));
  }
  if (!changes.empty()) return absl::StrJoin(changes, "; ");
  return "id: expected what the set was begun with, got another seed, follower_start, "
         "follower_start_side, partner_direction, constraints or keyframes";
}

// Whether only the labels may differ, which are drawn from the content of the leader: the item
// failed because of a leader that was mended since.
bool IsDrawnAnew(const ordered_json& record, const Item& item) {
  return item.drawn && record["state"] == kFailed &&
         record.value("leader", "") == item.leader->given && record.value("name", "") == item.name;
}

absl::StatusOr<Survey> OpenSurvey(const JobFolder& folder, const JobIdentity& identity) {
  for (const fs::path& file : {folder.journal(), folder.shards()}) {
    absl::Status status = RepairJournal(file, folder.temporary() / "journal");
    if (!status.ok()) return status;
  }
  absl::StatusOr<JournalReader> journal = JournalReader::Open(folder.journal());
  if (!journal.ok()) return journal.status();
  absl::StatusOr<ShardList> shards = OpenShards(*journal, identity, folder);
  if (!shards.ok()) return shards.status();
  return Survey{
      *std::move(journal),       *std::move(shards), {}, true, std::make_unique<LeaderDigests>(),
      std::make_unique<Makers>()};
}

}  // namespace

Surveyor::Surveyor(const JobFolder& folder, const JobIdentity& identity, bool retry_failed,
                   Survey survey)
    : folder_(folder),
      identity_(identity),
      retry_failed_(retry_failed),
      survey_(std::move(survey)),
      damage_(ReadDamage(folder.damage())),
      files_(folder.items(identity.packing), folder.spool()) {
  std::error_code error;
  const uint64_t bytes = fs::file_size(folder.spool(), error);
  if (!error) spool_bytes_ = bytes;
}

absl::StatusOr<std::unique_ptr<Surveyor>> Surveyor::Open(const JobFolder& folder,
                                                         const JobIdentity& identity,
                                                         bool retry_failed) {
  absl::StatusOr<Survey> survey = OpenSurvey(folder, identity);
  if (!survey.ok()) return survey.status();
  return std::unique_ptr<Surveyor>(
      new Surveyor(folder, identity, retry_failed, *std::move(survey)));
}

absl::StatusOr<bool> Surveyor::Add(const Item& item) {
  if (!survey_.journal.Has(item.number)) return false;
  const absl::StatusOr<JournalEntry> entry = survey_.journal.Read(item.number);
  if (!entry.ok()) return entry.status();
  const absl::StatusOr<ordered_json> record = ParseRecord(entry->record);
  if (!record.ok()) return false;  // the run requests it again
  // A changed leader comes first, because it may also change the labels that are drawn from it.
  const bool same_leader = record->value("leader", "") == item.leader->given;
  absl::Status status = same_leader ? CheckLeader(*item.leader, *record) : absl::OkStatus();
  if (!status.ok()) return status;
  if (record->value("id", "") != item.id && !IsDrawnAnew(*record, item)) {
    return absl::FailedPreconditionError(absl::StrCat(
        folder_.out().string(), ": item ", item.number, " (", item.name,
        "): ", DescribeChange(*record, item, identity_),
        ". Keep the leaders in their order and add new ones at the end, or use another --out"));
  }
  status = survey_.makers->CheckRecord(*record);
  if (!status.ok()) return status;
  const absl::StatusOr<bool> settled = IsSettled(item.number, *record, entry->place);
  if (!settled.ok() || !*settled) return settled;
  const auto at = static_cast<size_t>(item.number);
  if (survey_.settled.size() <= at) survey_.settled.resize(at + 1);
  survey_.settled[at] = true;
  return true;
}

absl::Status Surveyor::CheckLeader(const LeaderEntry& leader, const ordered_json& record) {
  const std::string sha256 = record.value("leader_sha256", "");
  if (sha256.empty()) return absl::OkStatus();
  const bool first = !survey_.leaders->Knows(leader);
  absl::Status status = survey_.leaders->Check(leader, sha256);
  if (!status.ok() || !first) return status;
  // Only items that are not settled need a leader that no longer exists.
  const absl::StatusOr<std::string> now = DigestOfLeader(leader);
  return now.ok() ? survey_.leaders->Check(leader, *now) : absl::OkStatus();
}

absl::StatusOr<bool> Surveyor::IsSettled(int64_t item, const ordered_json& record,
                                         const SpoolPlace& place) {
  if (damage_.items.count(item) > 0) return false;
  if (record["state"] == kFailed) return !retry_failed_;
  if (record["state"] == kRejected) return true;
  if (identity_.packing == Packing::kNone) return HasFiles(record);
  const size_t shard = survey_.shards.ShardOf(item);
  if (shard == ShardList::kNone) {
    survey_.all_packed = false;
    return IsInSpool(record, place);
  }
  const absl::StatusOr<const std::set<int64_t>*> bad = BadItemsOf(shard);
  if (!bad.ok()) return bad.status();
  return (*bad)->count(item) == 0 || CanReadSpool(record, place);
}

bool Surveyor::HasFiles(const ordered_json& record) const {
  for (const ordered_json& file : record["files"]) {
    std::error_code error;
    const fs::path path = folder_.out() / file["path"].get<std::string>();
    const uint64_t bytes = fs::file_size(path, error);
    if (error || bytes != file["bytes"].get<uint64_t>()) return false;
  }
  return true;
}

bool Surveyor::IsInSpool(const ordered_json& record, const SpoolPlace& place) const {
  // Earlier versions stored a file for each item.
  if (!place.has_value()) return CanReadSpool(record, place);
  uint64_t end = *place;
  for (const ordered_json& file : record["files"]) end += file["bytes"].get<uint64_t>();
  return end <= spool_bytes_;
}

bool Surveyor::CanReadSpool(const ordered_json& record, const SpoolPlace& place) const {
  for (size_t i = 0; i < record["files"].size(); ++i) {
    if (!files_.Read(record, place, i).ok()) return false;
  }
  return true;
}

// Reads a shard once, and only if its file is not as its entry describes it.
absl::StatusOr<const std::set<int64_t>*> Surveyor::BadItemsOf(size_t number) {
  const auto known = bad_.find(number);
  if (known != bad_.end()) return &known->second;
  const PackedShard& shard = survey_.shards.shards()[number];
  const fs::path file = folder_.out() / survey_.shards.NameOf(number, identity_.packing);
  std::set<int64_t>& bad = bad_[number];
  if (LooksWhole(shard, file)) return &bad;
  absl::StatusOr<std::set<int64_t>> found = FindBadItems(survey_.journal, shard, file);
  if (!found.ok()) return found.status();
  bad = *std::move(found);
  return &bad;
}

}  // namespace duet::client::batch
