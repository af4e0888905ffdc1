#ifndef DUET_CLIENT_BATCH_CAPTURE_LAYOUT_H_
#define DUET_CLIENT_BATCH_CAPTURE_LAYOUT_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/recipe.h"
#include "client/result.h"
#include "model/dataset/layout.h"

namespace duet::client::batch {

// Data sets that lie as those of captures do, so that whatever reads the captures reads them.

// What an output's layout says of captures: SBU's or K3HI's. Null for layouts of our own.
const dataset::DatasetLayout* CapturesOf(Layout layout);

// Whether a model's answers can be written so. INVALID_ARGUMENT for other joints.
absl::Status CheckJoints(const dataset::DatasetLayout& captures, const ModelInfo& model);

// The folder that a class's clips lie in: "s01s02/03" or "kicking". Of SBU the set is the last part
// of the leader's path that is named as one, s00s00 where there is none. INVALID_ARGUMENT for a
// class that the captures do not have.
absl::StatusOr<std::string> CaptureFolder(Layout layout, const std::string& interaction_class,
                                          const std::string& leader);

// The clip of a number, from 1, in its folder, without its ending: "s01s02/03/001/skeleton_pos".
std::string CaptureName(Layout layout, const std::string& folder, int number);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_CAPTURE_LAYOUT_H_
