#ifndef DUET_MODEL_FORMATS_BVH_FRAME_TIME_H_
#define DUET_MODEL_FORMATS_BVH_FRAME_TIME_H_

#include <optional>

#include "absl/strings/string_view.h"

namespace duet::formats::bvh {

// The number of decimals of a number such as ".0333"; absent for one in another notation.
std::optional<int> DecimalsOf(absl::string_view number);

// The rate in Hz that a written frame time stands for. Exporters round: .0333 is 1/30, .0167 is
// 1/60, .0083 is 1/120. In this order:
//
// - an integer whose frame time this is;
// - the common rate nearest to it (24, 30, 60, ...) whose frame time has these decimals, rounded,
// or
//   of four decimals and more also truncated;
// - an integer within half a per mille;
// - a broadcast rate (29.97, 59.94) whose frame time has these decimals;
// - the rate as it is.
double RateOfFrameTime(double seconds, std::optional<int> decimals);

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_FRAME_TIME_H_
