#ifndef DUET_MODEL_FORMATS_FLAT_NPY_H_
#define DUET_MODEL_FORMATS_FLAT_NPY_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/recorded_motion.h"

namespace duet::formats::flat {

// NumPy's array file: float32 or float64, little-endian, C order, [frames, joints, 3] or
// [people, frames, joints, 3] with one or two people. It names no joints and no frame rate: the
// joints are `joint_names` in their order, the rate comes out as 0.
//
// Source: the .npy format, versions 1.0 to 3.0 (numpy.lib.format).
// Errors: INVALID_ARGUMENT naming `source`, what came and what was wanted.
absl::StatusOr<motion::RecordedMotion> ParseNpy(absl::string_view bytes, absl::string_view source,
                                                const std::vector<std::string>& joint_names);

// float32 [2, frames, joints, 3], leader first; of one person [frames, joints, 3]. The pair is as
// CheckPair wants it, one person as CheckClip does.
std::string FormatNpy(const motion::ClipPair& pair);
std::string FormatNpy(const motion::Clip& person);

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_NPY_H_
