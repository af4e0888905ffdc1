#ifndef DUET_CLIENT_BATCH_SETUP_H_
#define DUET_CLIENT_BATCH_SETUP_H_

#include <memory>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/job_folder.h"
#include "client/batch/recipe.h"
#include "client/client.h"

namespace duet::client::batch {

// The models that answer, asked of a server: those that the job was begun with, or else what the
// recipe's stand for today. Errors as Client::GetModel.
absl::StatusOr<std::vector<ModelInfo>> ResolveModels(const Client& client, const Recipe& recipe,
                                                     const std::vector<ModelChoice>& begun);

// What a job of this recipe is known by; no models yet.
JobIdentity IdentityOf(const Recipe& recipe, const Shard& shard);
// The same once it has begun.
JobIdentity WithModels(JobIdentity identity, const std::vector<ModelInfo>& models,
                       const std::vector<motion::Skeleton>& skeletons);

// Where a shard's data set lies: `out` itself unless there are several.
std::filesystem::path ShardFolder(const std::filesystem::path& out, const Shard& shard);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SETUP_H_
