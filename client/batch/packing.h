#ifndef DUET_CLIENT_BATCH_PACKING_H_
#define DUET_CLIENT_BATCH_PACKING_H_

#include <cstddef>
#include <filesystem>
#include <set>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/recipe.h"
#include "client/batch/shard_list.h"

namespace duet::client::batch {

// The list of a set's shards. For a set that was packed before lists existed, the list has all done
// items, in their order. Errors: those of the list and the journal.
absl::StatusOr<ShardList> OpenShards(const JournalReader& journal, const JobIdentity& identity,
                                     const JobFolder& folder);

// Whether a shard's file exists and has its size; does not read it.
bool LooksWhole(const PackedShard& shard, const std::filesystem::path& file);

// The items of a shard whose files do not match the journal; all items if the shard cannot be read.
absl::StatusOr<std::set<int64_t>> FindBadItems(const JournalReader& journal,
                                               const PackedShard& shard,
                                               const std::filesystem::path& file);

// Writes new shards for done items that are in no shard, and rewrites missing or damaged shards
// with the same items. Each shard is written under a temporary name first. Removes the files of
// items whose shard is on disk, and the record of repaired damage. Continues after an interruption.
//
// Errors: ABORTED; also if an item's file does not match the journal, which is recorded as damage
// that the next run repairs.
absl::Status Pack(const JournalReader& journal, const JobIdentity& identity,
                  const JobFolder& folder);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_PACKING_H_
