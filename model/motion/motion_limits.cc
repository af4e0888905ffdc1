#include "model/motion/motion_limits.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/text.h"

namespace duet::motion {

absl::Status CheckFrameRate(absl::string_view source, double frame_rate_hz) {
  if (frame_rate_hz > 0 && frame_rate_hz <= kMaxFrameRateHz) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(source, ": frame rate: expected more than 0 and at most ", kMaxFrameRateHz,
                   " Hz, got ", base::NumberText(frame_rate_hz)));
}

bool ParseCoordinate(absl::string_view text, float* value) {
  double number = 0;
  if (!base::ParseNumber(text, &number) || std::abs(number) > kMaxCoordinate) return false;
  *value = static_cast<float>(number);
  return true;
}

std::string ExpectedCoordinate(absl::string_view text) {
  double number = 0;
  const bool too_large = base::ParseNumber(text, &number);
  return absl::StrCat("expected a finite number",
                      too_large ? absl::StrFormat(" within +-%.0f", kMaxCoordinate) : "", ", got ",
                      base::Quoted(text));
}

}  // namespace duet::motion
