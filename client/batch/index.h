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
#include "client/batch/set_file.h"
#include "client/batch/shard_list.h"

namespace duet::client::batch {

// The planned items.
struct PlannedItems {
  int64_t count = 0;
  bool whole = false;   // a run has reached the end of the plan: `count` is final
  int64_t missing = 0;  // neither done, rejected nor failed; only set by ReadPlanned
};

// Puts into `files` index.jsonl, index.tsv and the tables of item_table.h (done items),
// rejected.tsv, failed.tsv (failures.h), README.md unless it is the user's (dataset_card.h),
// dataset.json and summary.json, in the order of the items and without times. The files only depend
// on the journal records, not on their order. `shards` is empty if the set is not packed.
absl::StatusOr<SetCounts> WriteIndex(const JournalReader& journal, const JobIdentity& identity,
                                     const ShardList& shards, const PlannedItems& planned,
                                     SetFiles* files);

// The line of a done item in index.jsonl, without newline. Adds its shard and its split to
// `record`.
std::string IndexLine(int64_t item, const JobIdentity& identity, const ShardList& shards,
                      nlohmann::ordered_json* record);

// Reads the plan from summary.json. NOT_FOUND if it is missing, DATA_LOSS if it cannot be read.
absl::StatusOr<PlannedItems> ReadPlanned(const std::filesystem::path& out);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_INDEX_H_
