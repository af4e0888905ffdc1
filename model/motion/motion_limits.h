#ifndef DUET_MODEL_MOTION_MOTION_LIMITS_H_
#define DUET_MODEL_MOTION_MOTION_LIMITS_H_

#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

// Limits on motions in files, in every format.

namespace duet::motion {

// Above every motion that the service accepts (10 minutes at kMaxServedFrameRateHz). A wrong file
// is rejected before it fills the memory.
inline constexpr std::size_t kMaxMotionFileBytes = std::size_t{512} << 20;
inline constexpr int kMaxMotionFrames = 200'000;
inline constexpr int kMaxFileJoints = 1024;
inline constexpr double kMaxFrameRateHz = 1000;
// The maximum for requests, and therefore for models and data sets.
inline constexpr double kMaxServedFrameRateHz = 240;
// Far beyond any capture in any unit, and small enough for exact arithmetic in float.
inline constexpr double kMaxCoordinate = 1e7;

// INVALID_ARGUMENT naming `source` unless the rate is more than 0 and at most kMaxFrameRateHz.
absl::Status CheckFrameRate(absl::string_view source, double frame_rate_hz);

// Parses all of `text` as one number within +-kMaxCoordinate; returns false otherwise.
bool ParseCoordinate(absl::string_view text, float* value);

// What to report about a text that ParseCoordinate rejects: "expected ..., got ...".
std::string ExpectedCoordinate(absl::string_view text);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_MOTION_LIMITS_H_
