#ifndef DUET_MODEL_MOTION_MOTION_LIMITS_H_
#define DUET_MODEL_MOTION_MOTION_LIMITS_H_

#include <cstddef>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

// What a motion in a file may be, in every format alike.

namespace duet::motion {

// Above every motion that the service accepts (10 minutes at kMaxServedFrameRateHz), so that a
// wrong file is refused before it fills the memory.
inline constexpr std::size_t kMaxMotionFileBytes = std::size_t{512} << 20;
inline constexpr int kMaxMotionFrames = 200'000;
inline constexpr int kMaxFileJoints = 1024;
inline constexpr double kMaxFrameRateHz = 1000;
// The most that the service accepts, and so what models and data sets may have.
inline constexpr double kMaxServedFrameRateHz = 240;
// Far beyond any capture in any unit, and small enough for exact arithmetic in float.
inline constexpr double kMaxCoordinate = 1e7;

// Refuses a rate that is no rate: "frame rate: came -3, wanted more than 0 and at most 1000 Hz".
absl::Status CheckFrameRate(absl::string_view source, double frame_rate_hz);

// The whole of `text` as one number within +-kMaxCoordinate; false otherwise.
bool ParseCoordinate(absl::string_view text, float* value);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_MOTION_LIMITS_H_
