#include "client/batch/setup.h"

#include <utility>

#include "absl/strings/str_cat.h"

namespace duet::client::batch {

absl::StatusOr<std::vector<ModelInfo>> ResolveModels(const Client& client, const Recipe& recipe,
                                                     const std::vector<ModelChoice>& begun) {
  std::vector<ModelInfo> models;
  for (const ModelChoice& choice : begun.empty() ? recipe.models : begun) {
    absl::StatusOr<ModelDetails> details = client.GetModel(choice);
    if (!details.ok()) return details.status();
    models.push_back(std::move(details->model));
  }
  return models;
}

JobIdentity IdentityOf(const Recipe& recipe, const Shard& shard) {
  JobIdentity identity;
  identity.recipe_digest = recipe.digest;
  identity.recipe_json = recipe.json;
  identity.shard = shard;
  identity.layout = recipe.output.layout;
  identity.packing = recipe.output.packing;
  identity.shard_bytes = recipe.output.shard_bytes;
  return identity;
}

JobIdentity WithModels(JobIdentity identity, const std::vector<ModelInfo>& models,
                       const std::vector<motion::Skeleton>& skeletons) {
  identity.skeletons = skeletons;
  identity.models.clear();
  for (const ModelInfo& model : models) {
    ModelChoice choice;
    choice.name = model.name;
    choice.version = model.version;
    identity.models.push_back(std::move(choice));
  }
  return identity;
}

std::filesystem::path ShardFolder(const std::filesystem::path& out, const Shard& shard) {
  if (shard.count == 1) return out;
  return out / absl::StrCat("shard-", shard.index, "-of-", shard.count);
}

}  // namespace duet::client::batch
