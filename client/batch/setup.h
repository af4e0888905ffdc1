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

// What answers, and what its requests must keep to.
struct ResolvedModels {
  std::vector<ModelInfo> models;
  RequestLimits limits;
};

// The models that answer, asked of a server: those that the job was begun with, or else what the
// recipe's stand for today. Errors as Client::GetModel.
absl::StatusOr<ResolvedModels> ResolveModels(const Client& client, const Recipe& recipe,
                                             const std::vector<ModelChoice>& begun);

// What a job of this recipe is known by; no models yet.
JobIdentity IdentityOf(const Recipe& recipe, const Shard& shard);
// The same once it has begun.
JobIdentity WithModels(JobIdentity identity, const std::vector<ModelInfo>& models,
                       const std::vector<motion::Skeleton>& skeletons);

// The identity of a run that goes on with a set begun as `begun`, which has no models in a new set:
// what dataset.json states was settled then. FAILED_PRECONDITION if a model has other weights now.
absl::StatusOr<JobIdentity> GoOn(const JobIdentity& begun, JobIdentity identity);

// Where a shard's data set lies: `out` itself unless there are several.
std::filesystem::path ShardFolder(const std::filesystem::path& out, const Shard& shard);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SETUP_H_
