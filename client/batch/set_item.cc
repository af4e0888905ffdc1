#include "client/batch/set_item.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <system_error>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/batch/archive.h"
#include "client/batch/item_files.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/parse_record.h"
#include "client/batch/stored_pair.h"
#include "model/base/file.h"
#include "model/base/sha256.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr char kIndex[] = "index.jsonl";
constexpr char kDescription[] = "dataset.json";
constexpr size_t kMaxDescriptionBytes = size_t{16} << 20;
constexpr size_t kMaxSkeletons = 1000;
constexpr size_t kMaxJoints = 4096;
constexpr int64_t kMaxFrame = 1 << 30;

// A field that a foreign index may have as anything; -1 if it is no number.
int64_t Whole(const ordered_json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_number_integer() ? found->get<int64_t>() : -1;
}

bool IsNamed(const ordered_json& record, const std::string& item) {
  if (record["name"] == item || absl::StrCat(Whole(record, "item")) == item) {
    return true;
  }
  const ordered_json& files = record["files"];
  return std::any_of(files.begin(), files.end(),
                     [&item](const ordered_json& file) { return file["path"] == item; });
}

absl::StatusOr<ordered_json> FindRecord(const fs::path& set, const std::string& item) {
  const fs::path index = set / kIndex;
  std::ifstream lines(index);
  int64_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    // Parsing takes much longer than searching.
    if (!absl::StrContains(line, item)) continue;
    absl::StatusOr<ordered_json> record = ParseRecord(line);
    if (!record.ok() || !record->contains("files")) {
      return absl::DataLossError(absl::StrCat(index.string(), ":", number, ": is no entry"));
    }
    if (IsNamed(*record, item)) return record;
  }
  return absl::NotFoundError(absl::StrCat("item: expected the name or the number of an item of ",
                                          set.string(), ", got ", base::Quoted(item),
                                          "; index.jsonl lists them"));
}

absl::StatusOr<motion::Skeleton> ToSkeleton(const nlohmann::json& json) {
  base::ObjectReader reader(json, "skeletons");
  motion::Skeleton skeleton;
  skeleton.joint_names = reader.Strings("joint_names", kMaxJoints);
  int joint = 0;
  for (const nlohmann::json& parent : reader.Array("parents", kMaxJoints)) {
    if (!parent.is_number_integer()) reader.Fail("parents", "expected whole numbers");
    if (parent.is_number_integer() && parent.get<int64_t>() >= 0) {
      const int64_t index = std::min<int64_t>(parent.get<int64_t>(), kMaxJoints);
      skeleton.bones.push_back({static_cast<int>(index), joint});
    }
    ++joint;
  }
  skeleton.root = skeleton.Find(reader.String("root_joint", kMaxDescriptionBytes));
  absl::Status status = reader.Finish();
  if (status.ok()) status = motion::Validate(skeleton);
  if (!status.ok()) return status;
  return skeleton;
}

absl::StatusOr<motion::Skeleton> ReadSkeleton(const fs::path& set, uint64_t index) {
  const fs::path file = set / kDescription;
  const absl::StatusOr<std::string> text =
      base::ReadFile(file, kMaxDescriptionBytes, "a description of a data set");
  if (!text.ok()) return text.status();
  const nlohmann::json json = nlohmann::json::parse(*text, nullptr, false);
  const bool has = json.is_object() && json.contains("skeletons") && json["skeletons"].is_array() &&
                   json["skeletons"].size() <= kMaxSkeletons && index < json["skeletons"].size();
  if (!has) {
    return absl::DataLossError(
        absl::StrCat(file.string(), ": skeletons: expected one with number ", index, ", got none"));
  }
  absl::StatusOr<motion::Skeleton> skeleton = ToSkeleton(json["skeletons"][index]);
  if (skeleton.ok()) return skeleton;
  return absl::DataLossError(absl::StrCat(file.string(), ": ", skeleton.status().message()));
}

absl::StatusOr<std::string> ReadFromShard(const fs::path& shard, const ordered_json& file) {
  const std::string path = file["path"];
  absl::StatusOr<std::optional<ArchiveMember>> member = ArchiveReader(shard).Find(path);
  if (!member.ok()) return member.status();
  if (member->has_value() && base::Sha256Hex((*member)->content) == file["sha256"]) {
    return std::move((*member)->content);
  }
  return absl::DataLossError(absl::StrCat(shard.string(), ": ", path, ": was changed"));
}

// Items that wait to be packed are not in the set's folder; only the journal knows their place.
absl::StatusOr<std::string> ReadUnpacked(const fs::path& set, const ordered_json& record,
                                         size_t number) {
  const JobFolder folder(set);
  std::error_code error;
  const bool is_copy = !fs::exists(folder.journal(), error);
  if (is_copy) return ItemReader(set, "").Read(record, std::nullopt, number);
  const absl::StatusOr<JobIdentity> identity = ReadJobIdentity(set);
  if (!identity.ok()) return identity.status();
  const absl::StatusOr<JournalReader> journal = JournalReader::Open(folder.journal());
  if (!journal.ok()) return journal.status();
  SpoolPlace place;
  const int64_t item = Whole(record, "item");
  if (item >= 0 && journal->Has(item)) {
    const absl::StatusOr<JournalEntry> entry = journal->Read(item);
    if (!entry.ok()) return entry.status();
    place = entry->place;
  }
  return ItemReader(folder.items(identity->packing), folder.spool()).Read(record, place, number);
}

}  // namespace

bool IsSet(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / kIndex, error);
}

absl::StatusOr<SetItem> ReadSetItem(const fs::path& set, const std::string& item) {
  absl::StatusOr<ordered_json> record = FindRecord(set, item);
  if (!record.ok()) return record.status();
  absl::StatusOr<motion::Skeleton> skeleton =
      ReadSkeleton(set, record->value("skeleton", uint64_t{0}));
  if (!skeleton.ok()) return skeleton.status();
  const auto read = [&set, &record](size_t file) {
    if (!record->contains("shard")) return ReadUnpacked(set, *record, file);
    return ReadFromShard(set / (*record)["shard"].get<std::string>(), (*record)["files"][file]);
  };
  absl::StatusOr<motion::ClipPair> pair = ReadStoredPair(read, *record, *skeleton);
  if (!pair.ok()) return pair.status();
  return SetItem{*std::move(record), *std::move(pair), *std::move(skeleton)};
}

std::vector<WeightKeyframe> WeightsOf(const ordered_json& record) {
  const auto keyframe = [](int frame, const ordered_json& labels) {
    WeightKeyframe made;
    made.frame = frame;
    for (const auto& [name, weight] : labels.items()) {
      made.weights.push_back({name, weight.get<float>()});
    }
    return made;
  };
  if (record.contains("labels")) return {keyframe(0, record["labels"])};
  std::vector<WeightKeyframe> keyframes;
  if (!record.contains("keyframes")) return keyframes;
  for (const ordered_json& one : record["keyframes"]) {
    const int64_t frame = std::clamp<int64_t>(Whole(one, "frame"), 0, kMaxFrame);
    keyframes.push_back(keyframe(static_cast<int>(frame), one["labels"]));
  }
  return keyframes;
}

}  // namespace duet::client::batch
