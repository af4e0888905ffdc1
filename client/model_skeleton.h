#ifndef DUET_CLIENT_MODEL_SKELETON_H_
#define DUET_CLIENT_MODEL_SKELETON_H_

#include "absl/status/statusor.h"
#include "client/result.h"
#include "model/motion/skeleton.h"

namespace duet::client {

// Sets the landmarks of a skeleton by the names of its joints: left_hip and right_hip; left_foot
// and right_foot, or else left_ankle and right_ankle.
void FindLandmarks(motion::Skeleton* skeleton);

// Converts a model's joints to a skeleton with landmarks, for reading and writing motion files.
// Returns INTERNAL if the joints do not form a tree.
absl::StatusOr<motion::Skeleton> ToSkeleton(const ModelInfo& model);

}  // namespace duet::client

#endif  // DUET_CLIENT_MODEL_SKELETON_H_
