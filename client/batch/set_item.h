#ifndef DUET_CLIENT_BATCH_SET_ITEM_H_
#define DUET_CLIENT_BATCH_SET_ITEM_H_

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/request.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// One item of a data set, for programs that show it.
struct SetItem {
  nlohmann::ordered_json record;  // its line of index.jsonl
  motion::ClipPair pair;
  motion::Skeleton skeleton;
};

// Whether a folder is a data set of `duet batch`.
bool IsSet(const std::filesystem::path& folder);

// Reads an item of a set: finished or not, packed or not, and of a copy without .duet-batch.
// `item`: its number, its name, or the path of one of its files as in the index.
// Errors: NOT_FOUND if there is no such item or file, DATA_LOSS if a file was changed,
//         INVALID_ARGUMENT if a file cannot be read as a pair. The message names the file.
absl::StatusOr<SetItem> ReadSetItem(const std::filesystem::path& set, const std::string& item);

// The class weights of a record over time; one keyframe if they are constant.
std::vector<WeightKeyframe> WeightsOf(const nlohmann::ordered_json& record);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SET_ITEM_H_
