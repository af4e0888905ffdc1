#ifndef DUET_CLIENT_BATCH_CAPTURE_LAYOUT_H_
#define DUET_CLIENT_BATCH_CAPTURE_LAYOUT_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/recipe.h"
#include "client/result.h"
#include "model/dataset/layout.h"

namespace duet::client::batch {

// Data sets in the layouts of captures, so that programs that read captures can read them.

// The captures whose layout the output has: SBU or K3HI. Null for Duet's own layouts.
const dataset::DatasetLayout* CapturesOf(v1::Layout layout);

// INVALID_ARGUMENT if the model does not have the joints of the captures.
absl::Status CheckJoints(const dataset::DatasetLayout& captures, const ModelInfo& model);

// The folder of a class: "s01s02/03" or "kicking". For SBU, the set is the last part of the
// leader's path that has the form of one, or s00s00. INVALID_ARGUMENT for a class that the captures
// do not have.
absl::StatusOr<std::string> CaptureFolder(v1::Layout layout, const std::string& interaction_class,
                                          const std::string& leader);

// The path of a clip in its folder, without extension; numbers begin at 1:
// "s01s02/03/001/skeleton_pos".
std::string CaptureName(v1::Layout layout, const std::string& folder, int number);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_CAPTURE_LAYOUT_H_
