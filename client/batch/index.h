#ifndef DUET_CLIENT_BATCH_INDEX_H_
#define DUET_CLIENT_BATCH_INDEX_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/answer.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/recipe.h"
#include "client/result.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// What a data set holds, collected from the records of its items. Memory grows with the number of
// different frame rates and models, and of leaders that failed.
struct SetCounts {
  int64_t done = 0;
  int64_t rejected = 0;
  int64_t failed = 0;
  int64_t failed_leaders = 0;  // different files of items that failed
  std::string first_failure;   // why the first of them failed
  // Of the items that are done.
  uint64_t frames = 0;
  std::map<double, int64_t> items_by_rate;  // Hz
  std::map<std::string, MadeBy> made_by;    // the first item of each model, "name@version"
};

// What the items of a set are made with: the recipe, its models in its order, and their joints.
struct SetSource {
  Recipe recipe;
  std::vector<ModelInfo> models;
  std::vector<motion::Skeleton> skeletons;
};

// The index of each model's skeleton in dataset.json. Equal skeletons have the same index.
std::vector<int> SkeletonIndices(const std::vector<motion::Skeleton>& skeletons);

// The content of dataset.json: Dataset of proto/duet/batch/v1/dataset.proto. `planned`: the number
// of items of a finished set.
std::string DatasetJson(const SetSource& source, const SetCounts& counts, int64_t planned);

// Writes index.jsonl (done items), rejected.jsonl and failed.jsonl, in the order of the items and
// without times, and then dataset.json. They only depend on the journal's records, not on their
// order. Each replaces the one of an earlier run when it is finished.
absl::StatusOr<SetCounts> WriteIndex(const JournalReader& journal, const SetSource& source,
                                     int64_t planned, const JobFolder& folder);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_INDEX_H_
