#ifndef DUET_CLIENT_BATCH_DATASET_JSON_H_
#define DUET_CLIENT_BATCH_DATASET_JSON_H_

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "client/batch/index.h"
#include "client/batch/made_by.h"
#include "client/result.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// dataset.json: Dataset of proto/duet/batch/v1/dataset.proto.

// The statistics of the done items, collected from their records. Memory grows with the number of
// different frame rates and models.
struct DoneItems {
  void Add(const nlohmann::ordered_json& record);

  uint64_t frames = 0;
  std::map<double, int64_t> items_by_rate;  // Hz
  std::map<std::string, MadeBy> made_by;    // the first item of each model, "name@version"
};

// The index of each model's skeleton in dataset.json. Equal skeletons have the same index.
std::vector<int> SkeletonIndices(const std::vector<motion::Skeleton>& skeletons);

// "name@version"
std::string NameOfModel(const ModelInfo& model);

// The content of the file. `planned`: the number of items of a finished set.
std::string DatasetJson(const SetSource& source, const SetCounts& counts, int64_t planned,
                        const DoneItems& done);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_DATASET_JSON_H_
