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
// would have made it: checks every file against its digest, moves it, writes the index, packs if
// the recipe says so, and removes the folders of the shards. It can be repeated after an
// interruption.
//
// Errors: NOT_FOUND without shards; ABORTED if a shard is missing, locked or incomplete;
//         FAILED_PRECONDITION if the shards belong to different jobs or versions of a leader;
//         DATA_LOSS if a file was changed.
absl::StatusOr<MergeReport> Merge(const std::filesystem::path& out);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_MERGE_H_
