#include "client/batch/job_folder.h"

#include <system_error>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
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

// The file's skeletons have parts, which nobody asks for here.
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
  const nlohmann::ordered_json object = {{"format", kFormat},
                                         {"recipe_sha256", identity.recipe_digest},
                                         {"models", models},
                                         {"skeletons", skeletons},
                                         {"shard", ShardText(identity.shard)},
                                         {"layout", static_cast<int>(identity.layout)},
                                         {"packing", static_cast<int>(identity.packing)},
                                         {"shard_bytes", identity.shard_bytes}};
  return object.dump(2) + "\n";
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
    reader.Fail("skeletons", "wanted as many as models");
  }
  const absl::StatusOr<Shard> shard = ParseShard(reader.String("shard", 32));
  reader.Update(shard.status());
  if (shard.ok()) identity.shard = *shard;
  identity.layout = static_cast<Layout>(reader.Int("layout", 0, 3));
  identity.packing = static_cast<Packing>(reader.Int("packing", 0, 2));
  identity.shard_bytes = static_cast<uint64_t>(reader.Int("shard_bytes", 0, int64_t{1} << 40));
  absl::Status status = reader.Finish();
  if (!status.ok()) return status;
  return identity;
}

fs::path IdentityFile(const fs::path& out) { return out / ".duet-batch" / "job.json"; }

absl::Status CheckSame(const fs::path& out, const JobIdentity& begun, const JobIdentity& wanted) {
  const auto refuse = [&out](const std::string& what) {
    return absl::FailedPreconditionError(absl::StrCat(out.string(), ": was begun with ", what,
                                                      "; wanted the same, or another --out"));
  };
  if (begun.recipe_digest != wanted.recipe_digest) return refuse("another recipe");
  if (begun.shard.index != wanted.shard.index || begun.shard.count != wanted.shard.count) {
    return refuse("--shard " + ShardText(begun.shard));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<JobIdentity> ReadJobIdentity(const fs::path& out) {
  const fs::path file = IdentityFile(out);
  const absl::StatusOr<std::string> text = base::ReadFile(file, kMaxIdentityBytes, "a job");
  if (!text.ok()) return text.status();
  absl::StatusOr<JobIdentity> identity = FromJson(*text);
  if (identity.ok()) return identity;
  return absl::FailedPreconditionError(
      absl::StrCat(file.string(), ": ", identity.status().message()));
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
  if (!fs::exists(IdentityFile(out_), error)) return absl::OkStatus();
  absl::StatusOr<JobIdentity> identity = ReadJobIdentity(out_);
  if (!identity.ok()) return identity.status();
  *begun = *std::move(identity);
  return CheckSame(out_, *begun, wanted);
}

absl::Status JobFolder::Begin(const JobIdentity& identity) const {
  return ReplaceDurably(IdentityFile(out_), ToJson(identity));
}

}  // namespace duet::client::batch
