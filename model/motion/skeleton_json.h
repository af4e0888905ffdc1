#ifndef DUET_MODEL_MOTION_SKELETON_JSON_H_
#define DUET_MODEL_MOTION_SKELETON_JSON_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/base/strict_json.h"
#include "model/motion/body_part.h"
#include "model/motion/skeleton.h"

namespace duet::motion {

// The content of a "skeleton" object: a character and the parts that a network encodes.
struct SkeletonDocument {
  Skeleton skeleton;
  std::vector<BodyPart> parts;
};

// The "skeleton" object of manifest.json and dataset.json, which denotes joints by name:
//   {"joint_names": [...], "bones": [[parent, child], ...], "parts": [{"name", "joints"}, ...],
//    "root": ..., "left_hip": ..., "right_hip": ..., "left_foot": ..., "right_foot": ...}
// Hips and feet are optional, but each needs both sides.
//
// `value` is untrusted. Unknown, missing, repeated or mistyped fields, unknown joints, names that
// are too long and skeletons that Validate rejects are INVALID_ARGUMENT. The message names the
// field below `path`, the expected value and the actual one.
absl::StatusOr<SkeletonDocument> ReadSkeleton(const nlohmann::json& value, const std::string& path);

// The index of the joint `name`. If there is none, records an error at `key` and returns -1.
int FindJoint(base::ObjectReader* reader, const std::string& key, const Skeleton& skeleton,
              const std::string& name);

// Requires a skeleton and parts that Validate accepts.
nlohmann::ordered_json SkeletonToJson(const Skeleton& skeleton, const std::vector<BodyPart>& parts);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_SKELETON_JSON_H_
