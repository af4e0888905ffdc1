#ifndef DUET_CLIENT_BATCH_SHARD_H_
#define DUET_CLIENT_BATCH_SHARD_H_

#include <functional>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::client::batch {

// One of several jobs that make a data set together: the items whose id falls to it.
struct Shard {
  int index = 0;
  int count = 1;

  // Whether an item falls to this shard: a hash of its id, the same on every machine, so that
  // shards are alike in size whatever the order of the leaders.
  bool Has(absl::string_view item_id) const;
};

// Whether an item is in a share of a plan, 0 to 1: a hash of its id that no shard's hash looks at.
bool InShare(absl::string_view item_id, double share);

// "2/8": the third of eight. INVALID_ARGUMENT.
absl::StatusOr<Shard> ParseShard(absl::string_view text);

// What a cluster's environment says, 0/1 without one: JOB_COMPLETION_INDEX with JOB_COMPLETIONS
// (Kubernetes: set the second from spec.completions), SLURM_ARRAY_TASK_ID with _MIN and _COUNT,
// AWS_BATCH_JOB_ARRAY_INDEX with AWS_BATCH_JOB_ARRAY_SIZE. INVALID_ARGUMENT for an index without
// its count or beyond it.
using ReadVariable = std::function<std::optional<std::string>(const char* name)>;
absl::StatusOr<Shard> ShardFromEnvironment(const ReadVariable& read);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SHARD_H_
