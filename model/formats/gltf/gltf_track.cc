#include "model/formats/gltf/gltf_track.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace duet::formats::gltf {
namespace {

// Relative. The times of keys are float32; a frame's time differs from its key by their rounding.
constexpr double kSameTime = 1e-6;
// Seconds. Keys nearer than this to each other stand for a jump between two values.
constexpr double kJump = 1e-3;

using retargeting::Normalised;
using retargeting::Quaternion;
using retargeting::Vec3d;

}  // namespace

absl::StatusOr<GltfTrack> GltfTrack::Read(const GltfChannel& channel, GltfBuffers* buffers) {
  GltfTrack track;
  track.channel_ = channel;
  track.components_ = channel.path == GltfPath::kRotation ? 4 : 3;
  absl::StatusOr<std::vector<float>> times = buffers->Read(channel.times, 1);
  if (!times.ok()) return times.status();
  absl::StatusOr<std::vector<float>> values =
      buffers->Read(channel.values, static_cast<int>(track.components_));
  if (!values.ok()) return values.status();
  const std::size_t parts = channel.interpolation == GltfInterpolation::kCubicSpline ? 3 : 1;
  if (times->empty() || values->size() != times->size() * parts * track.components_) {
    return absl::InvalidArgumentError(
        absl::StrCat("accessors[", channel.values, "]: expected ", parts,
                     " values for each of at least 1 key, got ", values->size() / track.components_,
                     " for ", times->size(), " keys"));
  }
  if (std::adjacent_find(times->begin(), times->end(), std::greater_equal<float>()) !=
      times->end()) {
    return absl::InvalidArgumentError(
        absl::StrCat("accessors[", channel.times, "]: expected increasing times, got others"));
  }
  track.times_ = *std::move(times);
  track.values_ = *std::move(values);
  return track;
}

GltfTrack::Place GltfTrack::Find(double seconds) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), seconds,
                                      [](double a, float b) { return a < static_cast<double>(b); });
  if (after == times_.begin()) return {};
  const std::size_t key = static_cast<std::size_t>(after - times_.begin()) - 1;
  if (after == times_.end()) return {key, 0, 0};
  const double from = static_cast<double>(times_[key]), to = static_cast<double>(*after);
  // Elsewhere, neighbouring values hardly differ.
  const bool jumps = channel_.interpolation == GltfInterpolation::kStep || to - from < kJump;
  if (jumps && to - seconds <= kSameTime * std::max(1.0, std::abs(to))) return Find(to);
  return {key, (seconds - from) / (to - from), to - from};
}

double GltfTrack::Get(std::size_t key, Part part, std::size_t component) const {
  const bool spline = channel_.interpolation == GltfInterpolation::kCubicSpline;
  const std::size_t row = spline ? key * 3 + static_cast<std::size_t>(part) : key;
  return static_cast<double>(values_[row * components_ + component]);
}

double GltfTrack::Interpolate(const Place& place, std::size_t component) const {
  const double from = Get(place.key, kValue, component);
  if (place.share == 0 || channel_.interpolation == GltfInterpolation::kStep) return from;
  const double to = Get(place.key + 1, kValue, component);
  const double t = place.share;
  if (channel_.interpolation == GltfInterpolation::kLinear) return from + (to - from) * t;
  // glTF 2.0, appendix C: tangents are changes per second.
  const double leaves = place.step_seconds * Get(place.key, kOutTangent, component);
  const double arrives = place.step_seconds * Get(place.key + 1, kInTangent, component);
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * leaves + (-2 * t3 + 3 * t2) * to +
         (t3 - t2) * arrives;
}

Vec3d GltfTrack::VectorAt(double seconds) const {
  const Place place = Find(seconds);
  return {Interpolate(place, 0), Interpolate(place, 1), Interpolate(place, 2)};
}

Quaternion GltfTrack::RotationAt(double seconds) const {
  const Place place = Find(seconds);
  const auto key = [this](std::size_t k) {
    return Normalised({Get(k, kValue, 3), Get(k, kValue, 0), Get(k, kValue, 1), Get(k, kValue, 2)});
  };
  if (channel_.interpolation == GltfInterpolation::kLinear && place.share > 0) {
    return Slerp(key(place.key), key(place.key + 1), place.share);
  }
  return Normalised(
      {Interpolate(place, 3), Interpolate(place, 0), Interpolate(place, 1), Interpolate(place, 2)});
}

}  // namespace duet::formats::gltf
