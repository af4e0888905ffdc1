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

// The shards of a set, as its list says. A set that was packed before there were lists has one all
// the same: of all items that are done, in their order. Errors: the list's and the journal's.
absl::StatusOr<ShardList> OpenShards(const JournalReader& journal, const JobIdentity& identity,
                                     const JobFolder& folder);

// Whether a shard's file is there and of its size, as far as a look without reading it tells.
bool LooksWhole(const PackedShard& shard, const std::filesystem::path& file);

// The items of a shard whose files are not in it as the journal says, read member after member;
// all of them where it cannot be read.
absl::StatusOr<std::set<int64_t>> FindBadItems(const JournalReader& journal,
                                               const PackedShard& shard,
                                               const std::filesystem::path& file);

// Puts the files of every item that is done and in no shard into further shards, and writes again
// the shards that are missing or damaged, with the items that they had: each under another name
// first. Items' files are removed once their shard is on the disk. What was repaired is damage no
// longer. Goes on where it was stopped.
//
// Errors: ABORTED; also where an item's file is not what the journal says, which becomes damage
// that the next run repairs.
absl::Status Pack(const JournalReader& journal, const JobIdentity& identity,
                  const JobFolder& folder);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_PACKING_H_
