#ifndef DUET_CLIENT_BATCH_INDEX_H_
#define DUET_CLIENT_BATCH_INDEX_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/failures.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/recipe.h"
#include "client/batch/shard.h"
#include "client/result.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// The number of items in a data set by result.
struct SetCounts {
  int64_t done = 0;
  int64_t rejected = 0;
  int64_t failed = 0;
  int64_t failed_leaders = 0;  // different files of items that failed
  uint64_t bytes = 0;
  std::vector<FailureCause> failures;  // the causes of most items
};

// The planned items.
struct PlannedItems {
  int64_t count = 0;
  bool whole = false;  // a run has reached the end of the plan: `count` is final
};

// What the items of a set were made with. `models` and `skeletons` are those of the plan.
struct SetSource {
  const Recipe& recipe;
  const std::vector<ModelInfo>& models;
  const std::vector<motion::Skeleton>& skeletons;
  Shard shard;
};

// Writes index.jsonl and index.tsv (done items), rejected.tsv, failed.tsv (failures.h),
// dataset.json (dataset_json.h) and summary.json, in the order of the items and without times. The
// files only depend on the journal's records, not on their order. Each replaces the one of an
// earlier run when it is finished.
absl::StatusOr<SetCounts> WriteIndex(const JournalReader& journal, const SetSource& source,
                                     const PlannedItems& planned, const JobFolder& folder);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_INDEX_H_
