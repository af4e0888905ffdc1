#ifndef DUET_MODEL_FORMATS_FLAT_NPY_H_
#define DUET_MODEL_FORMATS_FLAT_NPY_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/recorded_motion.h"

namespace duet::formats::flat {

// Parses NumPy's array file: float32 or float64, little-endian, C order, [frames, joints, 3] or
// [people, frames, joints, 3] with one or two people. The file holds neither joint names nor a
// frame rate: the joints are `joint_names` in their order, and the returned rate is 0.
//
// Source: the .npy format, versions 1.0 to 3.0 (numpy.lib.format).
// Errors: INVALID_ARGUMENT naming `source`, the expected value and the actual one.
absl::StatusOr<motion::RecordedMotion> ParseNpy(absl::string_view bytes, absl::string_view source,
                                                const std::vector<std::string>& joint_names);

// Writes float32 [2, frames, joints, 3], leader first, or [frames, joints, 3] for one person.
// Requires people whom CheckPeople accepts.
std::string FormatNpy(const std::vector<motion::Clip>& people);

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_NPY_H_
