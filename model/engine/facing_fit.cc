#include "model/engine/facing_fit.h"

#include <cmath>
#include <cstddef>

#include "model/base/statistics.h"
#include "model/motion/resample.h"
#include "model/solver/partner.h"

namespace duet::engine {
namespace {

// The share of the time in which followers are not turned away farther.
constexpr double kShare = 0.9;
// Followers who are turned away farther than that go beside their leaders, or dance.
constexpr double kFarthestDegrees = 75;
constexpr double kLeastSeconds = 3;

}  // namespace

FacingFit::FacingFit(const motion::Skeleton& skeleton, double frame_rate_hz)
    : skeleton_(skeleton), frame_rate_hz_(frame_rate_hz), body_(body::FindBody(skeleton)) {}

void FacingFit::Add(const motion::Poses& leader, const motion::Poses& follower, int begin,
                    int end) {
  if (!skeleton_.hips || !body_.shoulders) return;
  for (const double degrees :
       solver::DegreesAway(skeleton_, body_, motion::Part(leader, begin, end - begin),
                           motion::Part(follower, begin, end - begin), frame_rate_hz_)) {
    // A follower who turns on is turned away by any angle.
    away_.push_back(std::abs(std::remainder(degrees, 360)));
  }
}

std::optional<double> FacingFit::Degrees() const {
  if (static_cast<double>(away_.size()) < kLeastSeconds * frame_rate_hz_) return std::nullopt;
  const double degrees = base::Quantile(away_, kShare);
  return degrees > kFarthestDegrees ? std::nullopt : std::optional<double>(degrees);
}

}  // namespace duet::engine
