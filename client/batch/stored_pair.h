#ifndef DUET_CLIENT_BATCH_STORED_PAIR_H_
#define DUET_CLIENT_BATCH_STORED_PAIR_H_

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "absl/status/statusor.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// Reads the pair of an item from the first file of its record. `read`: returns the content of a
// file of the record by its number. Errors name the file.
absl::StatusOr<motion::ClipPair> ReadStoredPair(
    const std::function<absl::StatusOr<std::string>(size_t)>& read,
    const nlohmann::ordered_json& record, const motion::Skeleton& skeleton);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_STORED_PAIR_H_
