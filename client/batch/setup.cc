#include "client/batch/setup.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/batch/encode.h"
#include "client/batch/text_values.h"

namespace duet::client::batch {

absl::StatusOr<ResolvedModels> ResolveModels(const Client& client, const Recipe& recipe,
                                             const std::vector<ModelChoice>& begun) {
  ResolvedModels resolved;
  for (const ModelChoice& choice : begun.empty() ? recipe.models : begun) {
    absl::StatusOr<ModelDetails> details = client.GetModel(choice);
    if (!details.ok()) return details.status();
    resolved.models.push_back(std::move(details->model));
    resolved.limits = details->limits;  // the same for all models of a server
  }
  return resolved;
}

JobIdentity IdentityOf(const Recipe& recipe, const Shard& shard) {
  JobIdentity identity;
  identity.recipe_digest = recipe.digest;
  identity.recipe_json = recipe.json;
  identity.shard = shard;
  identity.up = recipe.input.up;
  identity.seed_rule = recipe.seed_rule;
  identity.layout = recipe.output.layout;
  identity.packing = recipe.output.packing;
  identity.shard_bytes = recipe.output.shard_bytes;
  identity.description.formats = recipe.output.formats;
  identity.description.frame_rate_hz = RateOf(recipe.output);
  identity.description.splits = recipe.splits;
  return identity;
}

JobIdentity WithModels(JobIdentity identity, const std::vector<ModelInfo>& models,
                       const std::vector<motion::Skeleton>& skeletons) {
  identity.skeletons = skeletons;
  identity.models.clear();
  identity.description.models.clear();
  for (const ModelInfo& model : models) {
    ModelChoice choice;
    choice.name = model.name;
    choice.version = model.version;
    identity.models.push_back(std::move(choice));
    identity.description.models.push_back(Describe(model));
  }
  return identity;
}

absl::StatusOr<JobIdentity> GoOn(const JobIdentity& begun, JobIdentity identity) {
  const std::vector<DescribedModel>& before = begun.description.models;
  const std::vector<DescribedModel>& now = identity.description.models;
  for (size_t i = 0; i < std::min(before.size(), now.size()); ++i) {
    // Without digests, the weights cannot be compared.
    if (before[i].weights_sha256 == now[i].weights_sha256 || before[i].weights_sha256.empty() ||
        now[i].weights_sha256.empty()) {
      continue;
    }
    return absl::FailedPreconditionError(absl::StrCat(
        "model ", ModelText(identity.models[i]), ": expected the weights that the set was begun ",
        "with (SHA-256 ", before[i].weights_sha256, "), got ", now[i].weights_sha256,
        ". Serve those weights again, or choose another --out."));
  }
  if (!before.empty()) identity.description = begun.description;
  return identity;
}

std::filesystem::path ShardFolder(const std::filesystem::path& out, const Shard& shard) {
  if (shard.count == 1) return out;
  return out / absl::StrCat("shard-", shard.index, "-of-", shard.count);
}

}  // namespace duet::client::batch
