#ifndef DUET_CLIENT_BATCH_MERGE_H_
#define DUET_CLIENT_BATCH_MERGE_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/index.h"

namespace duet::client::batch {

struct MergeReport {
  SetCounts set;
  int64_t planned = 0;
  std::vector<int64_t> missing;  // the first hundred items that no shard has settled
};

// Joins the shards <out>/shard-0-of-N and so on into one data set at `out`, as a run without shards
// would have made it: checks every file against its digest, moves it, writes the index, packs where
// the recipe says so, and removes the shards' folders. Stopped at any moment it can be run again.
//
// Errors: NOT_FOUND without shards, ABORTED where one is absent, at work, or was not run to its
// end,
//         FAILED_PRECONDITION where they are not of one job or a leader was changed between them,
//         DATA_LOSS for a file that was changed.
absl::StatusOr<MergeReport> Merge(const std::filesystem::path& out);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_MERGE_H_
