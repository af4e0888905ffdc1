#include "client/batch/survey.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/batch/record.h"
#include "client/batch/text_values.h"
#include "model/base/sha256.h"
#include "model/base/strict_json.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// The fields in which an item differs from its record, each as 'labels: expected ..., got ...'.
std::string DescribeChange(const std::string& text, const Item& item, const JobIdentity& identity) {
  const ordered_json record = ordered_json::parse(text, nullptr, false);
  ordered_json now = FailedRecord(item, absl::OkStatus());
  now["model"] = ModelText(identity.models[static_cast<size_t>(item.model)].choice);
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
         "partner_direction or keyframes";
}

// Whether only the labels may differ, which are drawn from the content of the leader: the item
// failed because of a leader that was mended since.
bool IsDrawnAnew(const v1::IndexEntry& record, const Item& item) {
  return item.drawn && record.state() == kFailed && record.leader() == item.leader->given &&
         record.name() == item.name;
}

// Whether a file is there with its size and, if it is read, with its content.
bool IsWhole(const fs::path& out, const v1::IndexEntry::File& file, bool read) {
  const fs::path path = out / file.path();
  std::error_code error;
  const uint64_t bytes = fs::file_size(path, error);
  if (error || bytes != file.bytes()) return false;
  if (!read) return true;
  const absl::StatusOr<std::string> digest = base::Sha256HexOfFile(path);
  return digest.ok() && *digest == file.sha256();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Survey>> Survey::Open(const JobFolder& folder,
                                                     const JobIdentity& identity,
                                                     const Repeats& repeats) {
  absl::StatusOr<JournalReader> journal = JournalReader::Open(folder.journal());
  if (!journal.ok()) return journal.status();
  return std::unique_ptr<Survey>(new Survey(folder, identity, repeats, *std::move(journal)));
}

absl::Status Survey::Add(const Item& item) {
  if (!journal_.Has(item.number)) return absl::OkStatus();
  const absl::StatusOr<JournalEntry> entry = journal_.Read(item.number);
  if (!entry.ok()) return entry.status();
  const absl::StatusOr<v1::IndexEntry> record = ParseRecord(entry->record);
  if (!record.ok()) return absl::OkStatus();  // the run requests it again
  // A changed leader comes first, because it may also change the labels that are drawn from it.
  const bool same_leader = record->leader() == item.leader->given;
  absl::Status status = same_leader ? CheckLeader(*item.leader, *record) : absl::OkStatus();
  if (!status.ok()) return status;
  if (record->id() != item.id && !IsDrawnAnew(*record, item)) {
    return absl::FailedPreconditionError(absl::StrCat(
        folder_.out().string(), ": item ", item.number, " (", item.name,
        "): ", DescribeChange(entry->record, item, identity_),
        ". Keep the leaders in their order and add new ones at the end, or use another --out"));
  }
  status = makers_.CheckRecord(*record);
  if (!status.ok() || !IsSettledNow(*record)) return status;
  const auto at = static_cast<size_t>(item.number);
  if (settled_.size() <= at) settled_.resize(at + 1);
  settled_[at] = true;
  return absl::OkStatus();
}

absl::Status Survey::CheckLeader(const LeaderEntry& leader, const v1::IndexEntry& record) {
  const std::string& sha256 = record.leader_sha256();
  if (sha256.empty()) return absl::OkStatus();
  const bool first = !leaders_.Knows(leader);
  absl::Status status = leaders_.Check(leader, sha256);
  if (!status.ok() || !first) return status;
  // Only items that are not settled need a leader that no longer exists.
  const absl::StatusOr<std::string> now = base::Sha256HexOfFile(leader.file);
  return now.ok() ? leaders_.Check(leader, *now) : absl::OkStatus();
}

bool Survey::IsSettledNow(const v1::IndexEntry& record) const {
  if (record.state() == kFailed) return !repeats_.failed;
  if (record.state() == kRejected) return true;
  const auto& files = record.files();
  return std::all_of(files.begin(), files.end(), [this](const v1::IndexEntry::File& file) {
    return IsWhole(folder_.out(), file, repeats_.changed);
  });
}

}  // namespace duet::client::batch
