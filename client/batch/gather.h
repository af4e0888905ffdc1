#ifndef DUET_CLIENT_BATCH_GATHER_H_
#define DUET_CLIENT_BATCH_GATHER_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "client/batch/job_folder.h"

namespace duet::client::batch {

struct Gathered {
  int shards = 0;
  int count = 0;  // of the job
  int64_t items = 0;
};

// Moves what the shards of a job made, in the folders <out>/shard-INDEX-of-COUNT, into the set of
// `folder`, and removes their folders. A run without shards calls it before its survey, which
// compares the leaders and the makers of all items. `folder` is open for `wanted`; `begun` is the
// identity that it was begun with, and becomes that of the shards for a new set. It can be repeated
// after an interruption, and shards may be incomplete: the run makes what is missing.
//
// Errors: ABORTED if a shard is in use or a folder cannot be written; FAILED_PRECONDITION if a
// shard has another recipe or other models; DATA_LOSS for a damaged journal.
absl::StatusOr<Gathered> GatherShards(const JobIdentity& wanted, const JobFolder& folder,
                                      JobIdentity* begun);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_GATHER_H_
