#ifndef DUET_MODEL_DATASET_SKELETON_COMPLETION_H_
#define DUET_MODEL_DATASET_SKELETON_COMPLETION_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace duet::dataset {

// Completes a "skeleton" object without `parts`: adds the parts, and the root, hips and feet that
// are missing, from its bones and joint names (retargeting/anatomy.h). The root is the joint to
// which no bone leads. `notes` receives one line for each assumption. An object with `parts` is
// returned unchanged. If joints or bones cannot be read, the result has no parts, and
// motion::ReadSkeleton reports the error. Errors: INVALID_ARGUMENT naming the missing item and the
// fields that specify it.
absl::StatusOr<nlohmann::json> CompleteSkeleton(nlohmann::json skeleton,
                                                std::vector<std::string>* notes);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_SKELETON_COMPLETION_H_
