#include "client/batch/job_folder.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/batch/journal.h"
#include "client/batch/record.h"
#include "client/batch/text_values.h"
#include "model/base/file.h"
#include "model/base/strict_json.h"
#include "nlohmann/json.hpp"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kFormat = 2;
constexpr size_t kMaxIdentityBytes = size_t{16} << 20;
constexpr size_t kMaxRecipeBytes = size_t{8} << 20;
constexpr size_t kMaxModels = 1000;

std::string ShardText(const Shard& shard) { return absl::StrCat(shard.index, "/", shard.count); }

std::string ToJson(const JobIdentity& identity) {
  nlohmann::ordered_json models = nlohmann::ordered_json::array();
  for (const JobIdentity::Model& model : identity.models) {
    models.push_back({{"name", ModelText(model.choice)}, {"weights_sha256", model.weights_sha256}});
  }
  nlohmann::ordered_json object = {{"format", kFormat},
                                   {"recipe_sha256", identity.recipe_digest},
                                   {"recipe", identity.recipe_json},
                                   {"shard", ShardText(identity.shard)},
                                   {"models", models}};
  return object.dump(2) + "\n";
}

JobIdentity::Model ReadModel(const nlohmann::json& json, base::ObjectReader* parent) {
  base::ObjectReader reader(json, "models");
  const absl::StatusOr<ModelChoice> choice = ParseModelChoice(reader.String("name", 1000));
  reader.Update(choice.status());
  JobIdentity::Model model{choice.value_or(ModelChoice()), reader.String("weights_sha256", 64)};
  parent->Update(reader.Finish());
  return model;
}

absl::StatusOr<JobIdentity> FromJson(const std::string& text) {
  const absl::StatusOr<nlohmann::json> object = base::ParseStrictJson(text, 6);
  if (!object.ok()) return object.status();
  base::ObjectReader reader(*object, "");
  JobIdentity identity;
  reader.Int("format", kFormat, kFormat);
  identity.recipe_digest = reader.String("recipe_sha256", 64);
  identity.recipe_json = reader.String("recipe", kMaxRecipeBytes);
  const absl::StatusOr<Shard> shard = ParseShard(reader.String("shard", 32));
  reader.Update(shard.status());
  if (shard.ok()) identity.shard = *shard;
  for (const nlohmann::json& model : reader.Array("models", kMaxModels)) {
    identity.models.push_back(ReadModel(model, &reader));
  }
  absl::Status status = reader.Finish();
  if (!status.ok()) return status;
  return identity;
}

fs::path IdentityFile(const fs::path& out) { return out / ".duet-batch" / "job.json"; }

absl::Status Refuse(const fs::path& out, const std::string& begun_with) {
  return absl::FailedPreconditionError(absl::StrCat(out.string(), ": was begun with ", begun_with,
                                                    ". Use the same, or another --out"));
}

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

JobIdentity IdentityOf(const Recipe& recipe, const Shard& shard,
                       const std::vector<ModelInfo>& models) {
  JobIdentity identity{recipe.digest, recipe.json, shard, {}};
  for (const ModelInfo& model : models) {
    ModelChoice choice;
    choice.name = model.name;
    choice.version = model.version;
    identity.models.push_back({std::move(choice), model.weights_sha256});
  }
  return identity;
}

absl::Status CheckWeights(const JobIdentity& begun, const JobIdentity& now) {
  for (size_t i = 0; i < std::min(begun.models.size(), now.models.size()); ++i) {
    const std::string& before = begun.models[i].weights_sha256;
    const std::string& after = now.models[i].weights_sha256;
    // Without digests, the weights cannot be compared.
    if (before == after || before.empty() || after.empty()) continue;
    return absl::FailedPreconditionError(
        absl::StrCat("model ", ModelText(now.models[i].choice),
                     ": expected the weights that the set was begun ", "with (SHA-256 ", before,
                     "), got ", after, ". Serve those weights again, or choose another --out."));
  }
  return absl::OkStatus();
}

absl::StatusOr<JobIdentity> ReadJobIdentity(const fs::path& out) {
  const fs::path file = IdentityFile(out);
  const absl::StatusOr<std::string> text = base::ReadFile(file, kMaxIdentityBytes, "a job");
  if (!text.ok()) return text.status();
  absl::StatusOr<JobIdentity> identity = FromJson(*text);
  if (identity.ok()) return identity;
  return absl::FailedPreconditionError(absl::StrCat(
      file.string(), ": is damaged: ", identity.status().message(),
      ". To go on, restore it, or delete it and run the command that made the set again: items "
      "that are done are kept, if recipe, leaders and models are the same"));
}

absl::Status JobFolder::Open(const JobIdentity& wanted, JobIdentity* begun) {
  std::error_code error;
  fs::create_directories(state(), error);
  if (error) return CannotWrite(state(), error.value());
  absl::Status status = lock_.Take(state() / "lock");
  if (!status.ok()) return status;
  fs::remove_all(temporary(), error);
  fs::create_directory(temporary(), error);
  if (error) return CannotWrite(temporary(), error.value());
  return Compare(wanted, begun);
}

absl::Status JobFolder::Compare(const JobIdentity& wanted, JobIdentity* begun) const {
  std::error_code error;
  if (!fs::exists(IdentityFile(out_), error)) return absl::OkStatus();
  absl::StatusOr<JobIdentity> identity = ReadJobIdentity(out_);
  if (!identity.ok()) return identity.status();
  *begun = *std::move(identity);
  if (begun->recipe_digest != wanted.recipe_digest) {
    const std::string difference = DescribeDifference(begun->recipe_json, wanted.recipe_json);
    return Refuse(out_, difference.empty() ? "another recipe" : "another recipe: " + difference);
  }
  const bool same_shard =
      begun->shard.index == wanted.shard.index && begun->shard.count == wanted.shard.count;
  return same_shard ? absl::OkStatus() : Refuse(out_, "--shard " + ShardText(begun->shard));
}

absl::Status JobFolder::Begin(const JobIdentity& identity) const {
  return WriteDurably(temporary() / "job.json", IdentityFile(out_), ToJson(identity));
}

fs::path ShardFolder(const fs::path& out, const Shard& shard) {
  if (shard.count == 1) return out;
  return out / absl::StrCat("shard-", shard.index, "-of-", shard.count);
}

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
