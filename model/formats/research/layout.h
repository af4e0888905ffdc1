#ifndef DUET_MODEL_FORMATS_RESEARCH_LAYOUT_H_
#define DUET_MODEL_FORMATS_RESEARCH_LAYOUT_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/recorded_motion.h"

// What the numbers of an array mean in the data sets of research. An NPY file does not say it.

namespace duet::formats::research {

// Positions [frames, 22, 3], or the features of a data set. All are in metres.
//
//   humanml3d      positions, y up, 20 Hz
//   humanml3d-263  features [frames, 263] of one person, 20 Hz (humanml3d_features.h)
//   intergen       positions, y up, 30 Hz; or InterHuman's files [frames, 492], z up
//   intergen-262   features [people, frames, 262] or [frames, 262 people], 30 Hz
//                  (intergen_features.h)
//   inter-x        positions, y up, 30 Hz
enum class Layout { kHumanMl3d, kHumanMl3dFeatures, kInterGen, kInterGenFeatures, kInterX };

inline constexpr char kLayoutNames[] =
    "humanml3d, humanml3d-263, intergen, intergen-262 or inter-x";
absl::string_view LayoutName(Layout layout);
std::optional<Layout> ParseLayout(absl::string_view name);

// The frame rate of the data set.
double FrameRateOf(Layout layout);

// The layout of an array whose width no other has: [frames, 263], [frames, 262 or 524],
// [people, frames, 262] or [frames, 492]. Absent for all others: positions of 22 joints may be
// those of any data set. `why` receives the reason.
std::optional<Layout> GuessLayout(absl::string_view npy, std::string* why);

// Reads an array of a layout. Positions may also be [frames, 66], and of 24, 52 or 55 joints (SMPL,
// SMPL+H, SMPL-X), of which the first 22 are used; one or two people are [people, frames, 22, 3].
// The frame rate of the result is 0.
//
// Errors: INVALID_ARGUMENT naming `source`, the expected value and the actual one.
absl::StatusOr<motion::RecordedMotion> ParseNpyOf(Layout layout, absl::string_view npy,
                                                  absl::string_view source);

// One or two people as a layout holds them: the joints of BodySkeleton() (ToBody) at the layout's
// rate. `notes` receives what was placed or resampled; it may be null.
//
// Errors: INVALID_ARGUMENT if joints are missing, if features would have no frame, or for two
//         people in humanml3d-263, which does not hold where they are.
absl::StatusOr<std::vector<motion::Clip>> ToLayout(Layout layout,
                                                   const std::vector<motion::Clip>& people,
                                                   std::vector<std::string>* notes);

// The array of people of ToLayout.
std::string FormatNpyOf(Layout layout, const std::vector<motion::Clip>& people);

// What ParseNpyOf reads of that array: features lose the last frame, the floor, and the place and
// heading of the first person.
std::vector<motion::Clip> KeptBy(Layout layout, const std::vector<motion::Clip>& people);

}  // namespace duet::formats::research

#endif  // DUET_MODEL_FORMATS_RESEARCH_LAYOUT_H_
