#ifndef DUET_CLIENT_MODEL_SKELETON_H_
#define DUET_CLIENT_MODEL_SKELETON_H_

#include "absl/status/statusor.h"
#include "client/result.h"
#include "model/motion/skeleton.h"

namespace duet::client {

// A served model's joints as a skeleton, for reading and writing files. INTERNAL when they are no
// tree.
absl::StatusOr<motion::Skeleton> ToSkeleton(const ModelInfo& model);

}  // namespace duet::client

#endif  // DUET_CLIENT_MODEL_SKELETON_H_
