#ifndef DUET_CLIENT_BATCH_INDEX_H_
#define DUET_CLIENT_BATCH_INDEX_H_

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "absl/status/statusor.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/set_counts.h"
#include "client/batch/shard_list.h"

namespace duet::client::batch {

// How many items there should be.
struct PlannedItems {
  int64_t count = 0;
  bool whole = false;   // a run has come to the plan's end: there are no more
  int64_t missing = 0;  // neither done, rejected nor failed; of what is read alone
};

// Writes index.jsonl and index.tsv (items that are done), rejected.tsv (those that the filter did
// not let pass), failed.tsv (failures.h), dataset.json and summary.json into `out`, in the order of
// the items and without times: the same for the same journal records, in whatever order these were
// written. `shards` is empty of a set that is not packed.
absl::StatusOr<SetCounts> WriteIndex(const JournalReader& journal, const JobIdentity& identity,
                                     const ShardList& shards, const PlannedItems& planned,
                                     const std::filesystem::path& temporary,
                                     const std::filesystem::path& out);

// A done item's line of index.jsonl, without its end. `record` receives its shard.
std::string IndexLine(int64_t item, Packing packing, const ShardList& shards,
                      nlohmann::ordered_json* record);

// What summary.json says of the plan. NOT_FOUND without one, DATA_LOSS for one that cannot be read.
absl::StatusOr<PlannedItems> ReadPlanned(const std::filesystem::path& out);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_INDEX_H_
