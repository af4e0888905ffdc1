#ifndef DUET_CLIENT_BATCH_DATASET_JSON_H_
#define DUET_CLIENT_BATCH_DATASET_JSON_H_

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "client/batch/job_folder.h"
#include "client/batch/made_by.h"
#include "client/batch/set_counts.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// dataset.json: Dataset of proto/duet/batch/v1/dataset.proto.

// The statistics of the done items, collected from their records. Memory grows with the number of
// different frame rates, shards and models.
class DoneItems {
 public:
  // `record`: a done item, as in index.jsonl.
  void Add(const nlohmann::ordered_json& record);

  uint64_t frames() const { return frames_; }
  const std::map<double, int64_t>& items_by_rate() const { return items_by_rate_; }
  const std::vector<std::string>& shards() const { return shards_; }  // in the order of the items
  // How the items of a model, "name@version", were made; null if unknown.
  const MadeBy* made_by(const std::string& model) const;
  int64_t items_of(const std::string& split) const { return Of(split).items; }
  const std::vector<std::string>& shards_of(const std::string& split) const {
    return Of(split).shards;
  }

 private:
  struct OfSplit {
    int64_t items = 0;
    std::vector<std::string> shards;
  };
  const OfSplit& Of(const std::string& split) const;

  uint64_t frames_ = 0;
  std::map<double, int64_t> items_by_rate_;  // Hz
  std::vector<std::string> shards_;
  std::set<std::string> known_shards_;
  std::map<std::string, OfSplit> splits_;
  std::map<std::string, MadeBy> made_by_;  // the first item of each model
};

// The index of each model's skeleton in dataset.json. Equal skeletons have the same index.
std::vector<int> SkeletonIndices(const std::vector<motion::Skeleton>& skeletons);

// The content of the file. `planned`: the number of items of a finished set; `packed`: the shards
// exist.
std::string DatasetJson(const JobIdentity& identity, const SetCounts& counts, int64_t planned,
                        const DoneItems& done, bool packed);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_DATASET_JSON_H_
