#include "model/motion/vertical.h"

#include <cmath>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/base/angle.h"
#include "model/motion/posture.h"

namespace duet::motion {
namespace {

using base::kDegreesPerRadian;

// Before any evidence, a camera's tilt is nearly unknown: one radian.
constexpr double kAnyTilt = 1;
// A smaller tilt is level: it makes answers worse by less than they vary.
constexpr double kLeastTiltDegrees = 5;
constexpr double kSureDeviations = 3;
constexpr double kMostErrorDegrees = 3;
constexpr double kMostDisagreement = 3;

TiltVerdict Judge(const VerticalEstimate& estimate) {
  if (estimate.disagreement > kMostDisagreement) return TiltVerdict::kUnknown;
  if (estimate.tilt_degrees < kLeastTiltDegrees) {
    return estimate.error_degrees <= kMostErrorDegrees ? TiltVerdict::kLevel
                                                       : TiltVerdict::kUnknown;
  }
  return estimate.deviations >= kSureDeviations ? TiltVerdict::kTilted : TiltVerdict::kUnknown;
}

// "12.0 degrees (3.1 towards x, -11.6 towards z)"
std::string DescribeTilt(const VerticalEstimate& estimate) {
  const Lean lean = LeanOf(estimate.up);
  return absl::StrFormat("%.1f degrees (%.1f towards x, %.1f towards z; +- %.1f)",
                         estimate.tilt_degrees, lean.x, lean.z, estimate.error_degrees);
}

}  // namespace

absl::string_view VerdictName(TiltVerdict verdict) {
  switch (verdict) {
    case TiltVerdict::kLevel:
      return "level";
    case TiltVerdict::kTilted:
      return "tilted";
    case TiltVerdict::kUnknown:
      break;
  }
  return "unknown";
}

void VerticalEvidence::Add(const Clip& person) {
  if (!skeleton_.feet) return;
  floor_.Add(skeleton_, person);
  if (skeleton_.hips) bodies_.Add(skeleton_, person);
}

VerticalEstimate VerticalEvidence::Estimate() const {
  const std::optional<SlopeEstimate> floor = floor_.Estimate(), bodies = bodies_.Estimate();
  Information all = {1 / (kAnyTilt * kAnyTilt), 0, 1 / (kAnyTilt * kAnyTilt), 0, 0};
  if (floor) all += ToInformation(*floor);
  if (bodies) all += ToInformation(*bodies);
  const SlopeEstimate tilt = Solve(all);

  VerticalEstimate estimate;
  const Vec3 up = {static_cast<float>(tilt.mean.x), 1, static_cast<float>(tilt.mean.z)};
  estimate.up = up / Norm(up);
  estimate.tilt_degrees = std::atan(std::hypot(tilt.mean.x, tilt.mean.z)) * kDegreesPerRadian;
  estimate.error_degrees = tilt.LargestError() * kDegreesPerRadian;
  estimate.deviations = tilt.Deviations(tilt.mean);
  estimate.places = floor_.place_count();
  if (floor && bodies) {
    SlopeEstimate apart = *floor;
    apart.xx += bodies->xx;
    apart.xz += bodies->xz;
    apart.zz += bodies->zz;
    estimate.disagreement =
        apart.Deviations({floor->mean.x - bodies->mean.x, floor->mean.z - bodies->mean.z});
  }
  estimate.verdict = Judge(estimate);
  return estimate;
}

std::string Describe(const VerticalEstimate& estimate) {
  switch (estimate.verdict) {
    case TiltVerdict::kLevel:
      return absl::StrFormat("level within %g degrees (%.1f +- %.1f)", kLeastTiltDegrees,
                             estimate.tilt_degrees, estimate.error_degrees);
    case TiltVerdict::kTilted:
      return absl::StrCat("tilted by ", DescribeTilt(estimate));
    case TiltVerdict::kUnknown:
      break;
  }
  if (estimate.disagreement > kMostDisagreement) {
    return "cannot tell: the floor and the people disagree, as on a slope or stairs";
  }
  if (estimate.tilt_degrees < kLeastTiltDegrees) {
    const double most = estimate.tilt_degrees + 2 * estimate.error_degrees;
    if (most >= 90) return "no evidence of the vertical: nobody stands on both feet";
    return absl::StrFormat("no sign of a tilt, but up to %.0f degrees cannot be ruled out", most);
  }
  return absl::StrCat("cannot tell a tilted camera from people who lean: ", DescribeTilt(estimate));
}

}  // namespace duet::motion
