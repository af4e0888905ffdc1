#ifndef DUET_MODEL_MOTION_SKELETON_JSON_H_
#define DUET_MODEL_MOTION_SKELETON_JSON_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/body_part.h"
#include "model/motion/skeleton.h"

namespace duet::motion {

// What a "skeleton" object holds: a character and the parts that a network encodes it by.
struct SkeletonDocument {
  Skeleton skeleton;
  std::vector<BodyPart> parts;
};

// The "skeleton" object of manifest.json and dataset.json, joints by name:
//   {"joint_names": [...], "bones": [[parent, child], ...], "parts": [{"name", "joints"}, ...],
//    "root": ..., "left_hip": ..., "right_hip": ..., "left_foot": ..., "right_foot": ...}
// Hips and feet may be absent, both sides together.
//
// Reading is strict: unknown, missing, repeated or mistyped fields, unknown joints, names too long
// and what Validate refuses are INVALID_ARGUMENT, naming the field below `path`, what came and what
// was wanted. `value` may come from anywhere.
absl::StatusOr<SkeletonDocument> ReadSkeleton(const nlohmann::json& value, const std::string& path);

// Requires a skeleton and parts that Validate accepts.
nlohmann::ordered_json SkeletonToJson(const Skeleton& skeleton, const std::vector<BodyPart>& parts);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_SKELETON_JSON_H_
