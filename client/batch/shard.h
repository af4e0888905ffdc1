#ifndef DUET_CLIENT_BATCH_SHARD_H_
#define DUET_CLIENT_BATCH_SHARD_H_

#include <functional>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::client::batch {

// One of several jobs that make a data set together, each a part of the items.
struct Shard {
  int index = 0;
  int count = 1;

  // Whether an item belongs to this shard. Depends only on a hash of Item::place, so that the
  // shards have similar sizes on every machine and for every order of the leaders.
  bool Has(absl::string_view place) const;
};

// Whether an item is in a share of a plan, 0 to 1. Independent of the shard of the item.
bool InShare(absl::string_view place, double share);

// "2/8": the third of eight. INVALID_ARGUMENT.
absl::StatusOr<Shard> ParseShard(absl::string_view text);

// The shard of the cluster's environment, or 0/1 without one: JOB_COMPLETION_INDEX with
// JOB_COMPLETIONS (Kubernetes: set the second from spec.completions), SLURM_ARRAY_TASK_ID with _MIN
// and _COUNT, AWS_BATCH_JOB_ARRAY_INDEX with AWS_BATCH_JOB_ARRAY_SIZE. INVALID_ARGUMENT for an
// index without count, or outside it.
using ReadVariable = std::function<std::optional<std::string>(const char* name)>;
absl::StatusOr<Shard> ShardFromEnvironment(const ReadVariable& read);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SHARD_H_
