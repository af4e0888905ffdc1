#ifndef DUET_CLIENT_BATCH_STORED_PAIR_H_
#define DUET_CLIENT_BATCH_STORED_PAIR_H_

#include <filesystem>
#include <nlohmann/json.hpp>

#include "absl/status/statusor.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// Reads an item's pair back from the first of its record's files, below `items`. Errors name the
// file.
absl::StatusOr<motion::ClipPair> ReadStoredPair(const std::filesystem::path& items,
                                                const nlohmann::ordered_json& record,
                                                const motion::Skeleton& skeleton);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_STORED_PAIR_H_
