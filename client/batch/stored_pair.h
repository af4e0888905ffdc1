#ifndef DUET_CLIENT_BATCH_STORED_PAIR_H_
#define DUET_CLIENT_BATCH_STORED_PAIR_H_

#include <nlohmann/json.hpp>

#include "absl/status/statusor.h"
#include "client/batch/item_files.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// Reads the pair of an item from the first file of its record. Errors name the file.
absl::StatusOr<motion::ClipPair> ReadStoredPair(const ItemReader& items,
                                                const nlohmann::ordered_json& record,
                                                const SpoolPlace& place,
                                                const motion::Skeleton& skeleton);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_STORED_PAIR_H_
