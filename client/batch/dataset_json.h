#ifndef DUET_CLIENT_BATCH_DATASET_JSON_H_
#define DUET_CLIENT_BATCH_DATASET_JSON_H_

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "client/batch/job_folder.h"
#include "client/batch/set_counts.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// dataset.json: Dataset of proto/duet/batch/v1/dataset.proto.

// What it states about the items that are done, gathered from their records. Memory grows with the
// number of different frame rates and shards.
class DoneItems {
 public:
  // `record`: of an item that is done, as in index.jsonl.
  void Add(const nlohmann::ordered_json& record);

  uint64_t frames() const { return frames_; }
  const std::map<double, int64_t>& items_by_rate() const { return items_by_rate_; }
  const std::vector<std::string>& shards() const { return shards_; }  // in the order of the items

 private:
  uint64_t frames_ = 0;
  std::map<double, int64_t> items_by_rate_;  // Hz
  std::vector<std::string> shards_;
};

// For each model the index of its skeleton in dataset.json, where models that have the same share
// one.
std::vector<int> SkeletonIndices(const std::vector<motion::Skeleton>& skeletons);

// The file's content. `planned`: items that the set should have; `packed`: its shards are there.
std::string DatasetJson(const JobIdentity& identity, const SetCounts& counts, int64_t planned,
                        const DoneItems& done, bool packed);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_DATASET_JSON_H_
