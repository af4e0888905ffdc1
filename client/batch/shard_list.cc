#include "client/batch/shard_list.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace duet::client::batch {
namespace {

using nlohmann::json;

std::string ToJson(const PackedShard& shard) {
  json object = {{"items", shard.items}, {"bytes", shard.bytes}, {"sha256", shard.sha256}};
  if (!shard.split.empty()) object["split"] = shard.split;
  return object.dump();
}

bool IsRange(const json& range) {
  return range.is_array() && range.size() == 2 && range[0].is_number_unsigned() &&
         range[1].is_number_unsigned();
}

absl::StatusOr<PackedShard> FromJson(const std::string& text) {
  const json object = json::parse(text, nullptr, false);
  const absl::Status damaged = absl::DataLossError("is not a shard");
  if (!object.is_object() || !object.contains("items") || !object.contains("bytes") ||
      !object.contains("sha256") || !object["bytes"].is_number_unsigned() ||
      !object["sha256"].is_string() || (object.contains("split") && !object["split"].is_string())) {
    return damaged;
  }
  PackedShard shard;
  for (const json& range : object["items"]) {
    if (!IsRange(range)) return damaged;
    shard.items.emplace_back(range[0].get<int64_t>(), range[1].get<int64_t>());
  }
  shard.bytes = object["bytes"];
  shard.sha256 = object["sha256"];
  shard.split = object.value("split", "");
  return shard;
}

}  // namespace

std::string ShardName(Packing packing, size_t number, const std::string& split) {
  return absl::StrFormat("set-%s%s%06d.%s", split, split.empty() ? "" : "-", number,
                         packing == Packing::kTar ? "tar" : "npz");
}

absl::StatusOr<ShardList> ShardList::Open(const std::filesystem::path& file) {
  const absl::StatusOr<JournalReader> journal = JournalReader::Open(file);
  if (!journal.ok()) return journal.status();
  ShardList list;
  list.file_ = file;
  list.size_ = journal->size();
  list.shards_.resize(static_cast<size_t>(journal->end()));
  const absl::Status status = journal->ForEach([&list, &file](const JournalEntry& entry) {
    absl::StatusOr<PackedShard> shard = FromJson(entry.record);
    if (!shard.ok()) {
      return absl::DataLossError(
          absl::StrCat(file.string(), ": ", entry.item, ": ", shard.status().message()));
    }
    list.shards_[static_cast<size_t>(entry.item)] = *std::move(shard);
    return absl::OkStatus();
  });
  if (!status.ok()) return status;
  list.Reindex();
  return list;
}

void ShardList::Reindex() {
  ranges_.clear();
  for (size_t number = 0; number < shards_.size(); ++number) {
    for (const auto& [first, last] : shards_[number].items) {
      ranges_.push_back({first, last, number});
    }
  }
  std::sort(ranges_.begin(), ranges_.end(),
            [](const Range& a, const Range& b) { return a.first < b.first; });
}

size_t ShardList::ShardOf(int64_t item) const {
  const auto after =
      std::upper_bound(ranges_.begin(), ranges_.end(), item,
                       [](int64_t number, const Range& range) { return number < range.first; });
  if (after == ranges_.begin()) return kNone;
  const Range& range = *(after - 1);
  return item <= range.last ? range.shard : kNone;
}

void ShardList::Add(int64_t item, uint64_t bytes, uint64_t shard_bytes, const std::string& split) {
  Filling& filling = filling_[split];
  if (filling.shard == kNone || (filling.bytes > 0 && filling.bytes + bytes > shard_bytes)) {
    const auto unused = std::find_if(shards_.begin(), shards_.end(),
                                     [](const PackedShard& shard) { return shard.items.empty(); });
    filling = {static_cast<size_t>(unused - shards_.begin()), 0};
    if (unused == shards_.end()) shards_.emplace_back();
    shards_[filling.shard] = {};
    shards_[filling.shard].split = split;
    changed_.push_back(filling.shard);
  }
  filling.bytes += bytes;
  auto& items = shards_[filling.shard].items;
  if (items.empty() || items.back().second + 1 != item) items.emplace_back(item, item);
  items.back().second = item;
}

void ShardList::Set(size_t number, PackedShard shard) {
  shards_[number] = std::move(shard);
  changed_.push_back(number);
}

absl::Status ShardList::Commit() {
  Reindex();
  if (changed_.empty()) return absl::OkStatus();
  JournalWriter writer;
  absl::Status status = writer.Open(file_, size_);
  if (!status.ok()) return status;
  for (const size_t number : changed_) {
    writer.Add(static_cast<int64_t>(number), ToJson(shards_[number]));
  }
  status = writer.Commit();
  if (!status.ok()) return status;
  changed_.clear();
  const absl::StatusOr<JournalReader> journal = JournalReader::Open(file_);
  if (!journal.ok()) return journal.status();
  size_ = journal->size();
  return absl::OkStatus();
}

}  // namespace duet::client::batch
