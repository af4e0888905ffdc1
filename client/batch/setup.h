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

// The models, and the limits of their requests.
struct ResolvedModels {
  std::vector<ModelInfo> models;
  RequestLimits limits;
};

// The models as a server describes them: those that the job was begun with, or the recipe's for a
// new job. Errors: those of Client::GetModel.
absl::StatusOr<ResolvedModels> ResolveModels(const Client& client, const Recipe& recipe,
                                             const std::vector<ModelChoice>& begun);

// The identity of a job of this recipe, without models.
JobIdentity IdentityOf(const Recipe& recipe, const Shard& shard);
// The identity with the models that a new job uses.
JobIdentity WithModels(JobIdentity identity, const std::vector<ModelInfo>& models,
                       const std::vector<motion::Skeleton>& skeletons);

// The identity of a run that continues a set begun as `begun`, which has no models if the set is
// new: keeps the properties that dataset.json states. FAILED_PRECONDITION if the weights of a model
// have changed.
absl::StatusOr<JobIdentity> GoOn(const JobIdentity& begun, JobIdentity identity);

// The folder of a shard's data set: `out` itself unless there are several shards.
std::filesystem::path ShardFolder(const std::filesystem::path& out, const Shard& shard);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SETUP_H_
