#include "client/batch/job_folder.h"

#include <system_error>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "client/batch/journal.h"
#include "client/batch/parse_record.h"
#include "client/batch/recipe_difference.h"
#include "client/batch/record.h"
#include "client/batch/text_values.h"
#include "model/base/file.h"
#include "model/base/strict_json.h"
#include "model/motion/skeleton_json.h"
#include "nlohmann/json.hpp"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kFormat = 1;
constexpr size_t kMaxIdentityBytes = size_t{16} << 20;
constexpr size_t kMaxModels = 1000;

std::string ShardText(const Shard& shard) { return absl::StrCat(shard.index, "/", shard.count); }

// Body parts are not used here, so one part holds all joints.
std::vector<motion::BodyPart> WholeBody(const motion::Skeleton& skeleton) {
  motion::BodyPart body{"body", {}};
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) body.joints.push_back(joint);
  return {body};
}

std::string ToJson(const JobIdentity& identity) {
  nlohmann::ordered_json models = nlohmann::ordered_json::array();
  for (const ModelChoice& model : identity.models) {
    models.push_back(ModelText(model));
  }
  nlohmann::ordered_json skeletons = nlohmann::ordered_json::array();
  for (const motion::Skeleton& skeleton : identity.skeletons) {
    skeletons.push_back(SkeletonToJson(skeleton, WholeBody(skeleton)));
  }
  nlohmann::ordered_json object = {{"format", kFormat},
                                   {"recipe_sha256", identity.recipe_digest},
                                   {"models", models},
                                   {"skeletons", skeletons},
                                   {"shard", ShardText(identity.shard)},
                                   {"layout", static_cast<int>(identity.layout)},
                                   {"packing", static_cast<int>(identity.packing)},
                                   {"shard_bytes", identity.shard_bytes},
                                   {"description", ToJson(identity.description)},
                                   {"seed_rule", static_cast<int>(identity.seed_rule)}};
  if (identity.up) object["up"] = {identity.up->x, identity.up->y, identity.up->z};
  return object.dump(2) + "\n";
}

motion::Vec3 ReadUp(base::ObjectReader* reader) {
  std::vector<float> xyz;
  for (const nlohmann::json& value : reader->Array("up", 3)) {
    if (value.is_number()) xyz.push_back(value.get<float>());
  }
  if (xyz.size() == 3) return {xyz[0], xyz[1], xyz[2]};
  reader->Fail("up", "expected 3 numbers");
  return {};
}

absl::StatusOr<JobIdentity> FromJson(const std::string& text) {
  const absl::StatusOr<nlohmann::json> object = base::ParseStrictJson(text, 6);
  if (!object.ok()) return object.status();
  base::ObjectReader reader(*object, "");
  JobIdentity identity;
  reader.Int("format", kFormat, kFormat);
  identity.recipe_digest = reader.String("recipe_sha256", 64);
  for (const std::string& name : reader.Strings("models", kMaxModels)) {
    const absl::StatusOr<ModelChoice> model = ParseModelChoice(name);
    reader.Update(model.status());
    if (model.ok()) identity.models.push_back(*model);
  }
  for (const nlohmann::json& skeleton : reader.Array("skeletons", kMaxModels)) {
    absl::StatusOr<motion::SkeletonDocument> document = motion::ReadSkeleton(skeleton, "skeletons");
    reader.Update(document.status());
    if (document.ok()) identity.skeletons.push_back(std::move(document->skeleton));
  }
  if (reader.ok() && identity.skeletons.size() != identity.models.size()) {
    reader.Fail("skeletons", "expected as many as models");
  }
  const absl::StatusOr<Shard> shard = ParseShard(reader.String("shard", 32));
  reader.Update(shard.status());
  if (shard.ok()) identity.shard = *shard;
  identity.layout = static_cast<Layout>(reader.Int("layout", 0, 3));
  identity.packing = static_cast<Packing>(reader.Int("packing", 0, 2));
  identity.shard_bytes = static_cast<uint64_t>(reader.Int("shard_bytes", 0, int64_t{1} << 40));
  // Sets begun by earlier versions have none.
  if (reader.Has("description")) {
    absl::StatusOr<SetDescription> description =
        SetDescriptionFromJson(reader.Object("description"));
    reader.Update(description.status());
    if (description.ok()) identity.description = *std::move(description);
  }
  identity.seed_rule = reader.Has("seed_rule")
                           ? static_cast<SeedRule>(reader.Int("seed_rule", 1, 2))
                           : SeedRule::kPath;
  if (reader.Has("up")) identity.up = ReadUp(&reader);
  absl::Status status = reader.Finish();
  if (!status.ok()) return status;
  return identity;
}

fs::path IdentityFile(const fs::path& out) { return out / ".duet-batch" / "job.json"; }
fs::path RecipeFile(const fs::path& out) { return out / ".duet-batch" / "recipe.json"; }

absl::Status Refuse(const fs::path& out, const std::string& begun_with) {
  return absl::FailedPreconditionError(absl::StrCat(out.string(), ": was begun with ", begun_with,
                                                    ". Use the same, or another --out"));
}

absl::Status CheckSame(const fs::path& out, const JobIdentity& begun, const JobIdentity& wanted) {
  if (begun.recipe_digest != wanted.recipe_digest) {
    const std::string difference = DescribeDifference(begun.recipe_json, wanted.recipe_json);
    return Refuse(out, difference.empty() ? "another recipe" : "another recipe: " + difference);
  }
  if (begun.shard.index != wanted.shard.index || begun.shard.count != wanted.shard.count) {
    return Refuse(out, "--shard " + ShardText(begun.shard));
  }
  return absl::OkStatus();
}

// For a set whose identity was damaged and then deleted: its recipe is stored a second time.
absl::Status CheckRecipe(const fs::path& out, const JobIdentity& wanted) {
  const absl::StatusOr<std::string> recipe =
      base::ReadFile(RecipeFile(out), kMaxIdentityBytes, "a recipe");
  if (!recipe.ok()) return absl::OkStatus();
  const std::string difference = DescribeDifference(*recipe, wanted.recipe_json);
  return difference.empty() ? absl::OkStatus() : Refuse(out, "another recipe: " + difference);
}

}  // namespace

absl::StatusOr<JobIdentity> ReadJobIdentity(const fs::path& out) {
  const fs::path file = IdentityFile(out);
  const absl::StatusOr<std::string> text = base::ReadFile(file, kMaxIdentityBytes, "a job");
  if (!text.ok()) return text.status();
  absl::StatusOr<JobIdentity> identity = FromJson(*text);
  if (identity.ok()) {
    identity->recipe_json =
        base::ReadFile(RecipeFile(out), kMaxIdentityBytes, "a recipe").value_or("");
    return identity;
  }
  return absl::FailedPreconditionError(
      absl::StrCat(file.string(), ": is damaged: ", identity.status().message(),
                   ". To go on, restore it, or delete it and run the command that made the set "
                   "again: items that "
                   "are done are kept, if recipe, leaders and models are the same"));
}

absl::Status JobFolder::Take() {
  std::error_code error;
  fs::create_directories(state(), error);
  if (error) return CannotWrite(state(), error.value());
  absl::Status status = lock_.Take(state() / "lock");
  if (!status.ok()) return status;
  fs::remove_all(temporary(), error);
  // Temporary files of a process that was killed.
  fs::remove(out_ / "contact_sheet.html.partial", error);
  fs::create_directory(temporary(), error);
  return error ? CannotWrite(temporary(), error.value()) : absl::OkStatus();
}

absl::Status JobFolder::Open(const JobIdentity& wanted, JobIdentity* begun) {
  const absl::Status status = Take();
  return status.ok() ? Compare(wanted, begun) : status;
}

absl::Status JobFolder::Compare(const JobIdentity& wanted, JobIdentity* begun) const {
  std::error_code error;
  if (!fs::exists(IdentityFile(out_), error)) return CheckRecipe(out_, wanted);
  absl::StatusOr<JobIdentity> identity = ReadJobIdentity(out_);
  if (!identity.ok()) return identity.status();
  *begun = *std::move(identity);
  return CheckSame(out_, *begun, wanted);
}

absl::Status JobFolder::OpenForRun(const JobIdentity& wanted, JobIdentity* begun) {
  absl::Status status = Take();
  if (!status.ok()) return status;
  status = Compare(wanted, begun);
  if (!absl::IsFailedPrecondition(status) || HasAnswers()) return status;
  *begun = {};
  return Discard();
}

// A folder that cannot be read counts as one with answers, so that nothing useful is removed.
bool JobFolder::HasAnswers() const {
  std::error_code error;
  const fs::path index = out_ / "index.jsonl";
  if (fs::exists(index, error) && fs::file_size(index, error) > 0) return true;
  const absl::StatusOr<JournalReader> records = JournalReader::Open(journal());
  if (!records.ok() || records->damaged_lines() > 0) return true;
  const absl::Status all_failed = records->ForEach([](const JournalEntry& entry) {
    const absl::StatusOr<nlohmann::ordered_json> record = ParseRecord(entry.record);
    const bool failed = record.ok() && (*record)["state"] == kFailed;
    return failed ? absl::OkStatus() : absl::AlreadyExistsError("answered");
  });
  return !all_failed.ok();
}

// Removes job.json last: if the run is stopped before, the next run repeats this.
absl::Status JobFolder::Discard() const {
  for (const fs::path& path :
       {journal(), spool(), shards(), damage(), RecipeFile(out_), IdentityFile(out_)}) {
    std::error_code error;
    fs::remove_all(path, error);
    if (error) return CannotWrite(path, error.value());
  }
  return SyncFolder(state());
}

absl::Status JobFolder::Begin(const JobIdentity& identity) const {
  absl::Status status = ReplaceDurably(RecipeFile(out_), identity.recipe_json);
  return status.ok() ? ReplaceDurably(IdentityFile(out_), ToJson(identity)) : status;
}

}  // namespace duet::client::batch
