#ifndef DUET_CLIENT_MODEL_SKELETON_H_
#define DUET_CLIENT_MODEL_SKELETON_H_

#include "absl/status/statusor.h"
#include "client/result.h"
#include "model/motion/skeleton.h"

namespace duet::client {

// Converts a model's joints to a skeleton, for reading and writing motion files. The landmarks are
// found by name: left_hip and right_hip; left_foot and right_foot, or else left_ankle and
// right_ankle. Returns INTERNAL if the joints do not form a tree.
absl::StatusOr<motion::Skeleton> ToSkeleton(const ModelInfo& model);

}  // namespace duet::client

#endif  // DUET_CLIENT_MODEL_SKELETON_H_
