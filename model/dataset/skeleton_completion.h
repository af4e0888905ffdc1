#ifndef DUET_MODEL_DATASET_SKELETON_COMPLETION_H_
#define DUET_MODEL_DATASET_SKELETON_COMPLETION_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace duet::dataset {

// A "skeleton" object whose author left out `parts`: with the parts, and whichever of root, hips
// and feet are left out as well, found from its bones and its joints' names
// (retargeting/anatomy.h). The root is the joint that no bone leads to. What was assumed goes to
// `notes`, a line each. An object with `parts` comes back as it is; one whose joints and bones
// cannot be read does so with no parts, for motion::ReadSkeleton to say what is wrong with it.
// Errors: INVALID_ARGUMENT naming what could not be found, and the fields that say it.
absl::StatusOr<nlohmann::json> CompleteSkeleton(nlohmann::json skeleton,
                                                std::vector<std::string>* notes);

}  // namespace duet::dataset

#endif  // DUET_MODEL_DATASET_SKELETON_COMPLETION_H_
