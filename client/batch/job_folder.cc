#include "client/batch/job_folder.h"

#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/batch/answer.h"
#include "client/batch/journal.h"
#include "client/batch/text_values.h"
#include "model/base/file.h"
#include "model/messages/message_text.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kFormat = 2;
constexpr size_t kMaxIdentityBytes = size_t{16} << 20;
constexpr char kIdentityFile[] = ".duet-batch/job.json";

std::string ShardText(const Shard& shard) { return absl::StrCat(shard.index, "/", shard.count); }

absl::StatusOr<v1::Job> FromJson(const std::string& text) {
  v1::Job job;
  absl::Status status = messages::ParseMessage(text, messages::MessageSyntax::kJson, &job);
  if (!status.ok()) return status;
  if (job.format() != kFormat) {
    return absl::InvalidArgumentError(
        absl::StrCat("format: expected ", kFormat, ", got ", job.format()));
  }
  status = ParseShard(job.shard()).status();
  for (const v1::Job::Model& model : job.models()) {
    status.Update(ParseModelChoice(model.name()).status());
  }
  if (!status.ok()) return status;
  return job;
}

absl::Status Refuse(const fs::path& out, const std::string& begun_with) {
  return absl::FailedPreconditionError(absl::StrCat(out.string(), ": was begun with ", begun_with,
                                                    ". Use the same, or another --out"));
}

std::vector<fs::path> ShardFolders(const fs::path& out) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (fs::directory_iterator it(out, error), end; !error && it != end; it.increment(error)) {
    const bool named = absl::StartsWith(it->path().filename().string(), "shard-");
    if (named && ReadJob(it->path()).ok()) folders.push_back(it->path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

absl::Status CheckSameModels(const fs::path& shard, const v1::Job& first, const v1::Job& other) {
  const bool same =
      std::equal(first.models().begin(), first.models().end(), other.models().begin(),
                 other.models().end(), google::protobuf::util::MessageDifferencer::Equals);
  if (same) return absl::OkStatus();
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
  status = made->ForEach([&](int64_t item, const std::string& text) {
    const absl::StatusOr<v1::IndexEntry> record = ParseRecord(text);
    if (!record.ok()) return absl::OkStatus();  // the run requests it again
    journal.Add(item, text);
    ++*items;
    return MoveFiles(shard.out(), folder.out(), *record);
  });
  // Files before records, so that a record never names a missing file.
  if (status.ok()) status = SyncFileSystem(folder.out());
  return status.ok() ? journal.Commit() : status;
}

}  // namespace

v1::Job IdentityOf(const Recipe& recipe, const Shard& shard, const std::vector<ModelInfo>& models) {
  v1::Job job;
  job.set_format(kFormat);
  job.set_recipe_sha256(recipe.digest);
  job.set_recipe(recipe.json);
  job.set_shard(ShardText(shard));
  for (const ModelInfo& model : models) {
    v1::Job::Model* out = job.add_models();
    out->set_name(absl::StrCat(model.name, "@", model.version));
    out->set_weights_sha256(model.weights_sha256);
  }
  return job;
}

absl::Status CheckWeights(const v1::Job& begun, const v1::Job& now) {
  for (int i = 0; i < std::min(begun.models_size(), now.models_size()); ++i) {
    const std::string& before = begun.models(i).weights_sha256();
    const std::string& after = now.models(i).weights_sha256();
    // Without digests, the weights cannot be compared.
    if (before == after || before.empty() || after.empty()) continue;
    return absl::FailedPreconditionError(
        absl::StrCat("model ", now.models(i).name(),
                     ": expected the weights that the set was begun ", "with (SHA-256 ", before,
                     "), got ", after, ". Serve those weights again, or choose another --out."));
  }
  return absl::OkStatus();
}

absl::StatusOr<v1::Job> ReadJob(const fs::path& out) {
  const fs::path file = out / kIdentityFile;
  const absl::StatusOr<std::string> text = base::ReadFile(file, kMaxIdentityBytes, "a job");
  if (!text.ok()) return text.status();
  absl::StatusOr<v1::Job> job = FromJson(*text);
  if (job.ok()) return job;
  return absl::FailedPreconditionError(absl::StrCat(
      file.string(), ": is damaged: ", job.status().message(),
      ". To go on, restore it, or delete it and run the command that made the set again: items "
      "that are done are kept, if recipe, leaders and models are the same"));
}

absl::Status JobFolder::Open(const v1::Job& wanted, v1::Job* begun) {
  std::error_code error;
  fs::create_directories(state(), error);
  if (error) return CannotWrite(state(), error.value());
  absl::Status status = lock_.Take(state() / "lock");
  if (!status.ok()) return status;
  fs::remove_all(temporary(), error);
  fs::create_directory(temporary(), error);
  if (error) return CannotWrite(temporary(), error.value());
  if (!fs::exists(out_ / kIdentityFile, error)) return absl::OkStatus();
  absl::StatusOr<v1::Job> job = ReadJob(out_);
  if (!job.ok()) return job.status();
  *begun = *std::move(job);
  if (begun->recipe_sha256() != wanted.recipe_sha256()) {
    const std::string difference = DescribeDifference(begun->recipe(), wanted.recipe());
    return Refuse(out_, difference.empty() ? "another recipe" : "another recipe: " + difference);
  }
  return begun->shard() == wanted.shard() ? absl::OkStatus()
                                          : Refuse(out_, "--shard " + begun->shard());
}

absl::Status JobFolder::Begin(const v1::Job& job) const {
  FileGroup file(temporary(), out_);
  absl::Status status = file.Add(kIdentityFile, ToJson(job, /*add_whitespace=*/true));
  return status.ok() ? file.Commit() : status;
}

fs::path ShardFolder(const fs::path& out, const Shard& shard) {
  if (shard.count == 1) return out;
  return out / absl::StrCat("shard-", shard.index, "-of-", shard.count);
}

absl::StatusOr<Gathered> GatherShards(const v1::Job& wanted, const JobFolder& folder,
                                      v1::Job* begun) {
  Gathered gathered;
  for (const fs::path& path : ShardFolders(folder.out())) {
    const absl::StatusOr<v1::Job> job = ReadJob(path);
    if (!job.ok()) return job.status();
    v1::Job wanted_shard = wanted, begun_shard;
    wanted_shard.set_shard(job->shard());
    JobFolder shard(path);
    absl::Status status = shard.Open(wanted_shard, &begun_shard);
    if (!status.ok()) return status;
    begun_shard.set_shard(wanted.shard());
    if (begun->models().empty()) {
      *begun = begun_shard;
      status = folder.Begin(*begun);
    } else {
      status = CheckSameModels(path, *begun, begun_shard);
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
    gathered.count = ParseShard(job->shard())->count;
  }
  return gathered;
}

}  // namespace duet::client::batch
