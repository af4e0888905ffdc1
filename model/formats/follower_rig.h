#ifndef DUET_MODEL_FORMATS_FOLLOWER_RIG_H_
#define DUET_MODEL_FORMATS_FOLLOWER_RIG_H_

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"
#include "model/formats/motion_file.h"
#include "model/motion/clip.h"

namespace duet::formats {

// A BVH whose rig a follower is written onto, and how that file is read.
struct FollowerRig {
  std::filesystem::path file;
  ReadOptions reading;
};

// The follower as BVH on that rig (bvh::OntoBvhRig).
// Errors: those of reading the rig; INVALID_ARGUMENT for a rig that cannot be the follower's.
absl::StatusOr<std::string> FormatOntoRig(const motion::Clip& follower, const FollowerRig& rig);

}  // namespace duet::formats

#endif  // DUET_MODEL_FORMATS_FOLLOWER_RIG_H_
