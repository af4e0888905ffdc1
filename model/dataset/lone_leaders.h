#ifndef DUET_MODEL_DATASET_LONE_LEADERS_H_
#define DUET_MODEL_DATASET_LONE_LEADERS_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/motion/skeleton.h"

namespace duet::dataset {

// The files below a folder whose extension formats::ReadLeader reads, sorted. NOT_FOUND if the
// folder, or a folder in it, cannot be listed.
absl::StatusOr<std::vector<std::filesystem::path>> MotionFilesBelow(
    const std::filesystem::path& folder);

// Reads the motions of leaders without followers: of every motion file below `folder`, the first
// person, resampled to `frame_rate_hz`. They are not levelled.
//
// Errors: those of MotionFilesBelow; NOT_FOUND if there is no motion file; INVALID_ARGUMENT naming
//         the file for a motion of fewer than 2 frames; otherwise those of formats::ReadLeader.
absl::StatusOr<std::vector<LoneLeader>> ReadLoneLeaders(const std::filesystem::path& folder,
                                                        const motion::Skeleton& skeleton,
                                                        double frame_rate_hz);

// The SHA-256 digest of ids and motions: two lists with the same digest are the same.
std::string DigestOf(const std::vector<LoneLeader>& leaders);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_LONE_LEADERS_H_
