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

std::size_t ComponentsOf(const GltfChannel& channel) {
  return channel.path == GltfPath::kRotation ? 4 : 3;
}

// A time relative to the keys: the last key before it and the fraction of the step to the next.
struct KeyPlace {
  std::size_t key = 0;
  double share = 0;
  double step_seconds = 0;
};

KeyPlace FindKey(const GltfTrack& track, double seconds) {
  const std::vector<float>& times = track.times;
  const auto after = std::upper_bound(times.begin(), times.end(), seconds,
                                      [](double a, float b) { return a < static_cast<double>(b); });
  if (after == times.begin()) return {};
  const std::size_t key = static_cast<std::size_t>(after - times.begin()) - 1;
  if (after == times.end()) return {key, 0, 0};
  const double from = static_cast<double>(times[key]), to = static_cast<double>(*after);
  // Elsewhere, neighbouring values hardly differ.
  const bool jumps = track.channel.interpolation == GltfInterpolation::kStep || to - from < kJump;
  if (jumps && to - seconds <= kSameTime * std::max(1.0, std::abs(to))) return FindKey(track, to);
  return {key, (seconds - from) / (to - from), to - from};
}

// A component of a key's value, or of a tangent of a spline.
enum Part { kInTangent, kValue, kOutTangent };
double Get(const GltfTrack& track, std::size_t key, Part part, std::size_t component) {
  const bool spline = track.channel.interpolation == GltfInterpolation::kCubicSpline;
  const std::size_t row = spline ? key * 3 + static_cast<std::size_t>(part) : key;
  return static_cast<double>(track.values[row * ComponentsOf(track.channel) + component]);
}

// Interpolates one component.
double Interpolate(const GltfTrack& track, const KeyPlace& place, std::size_t component) {
  const double from = Get(track, place.key, kValue, component);
  if (place.share == 0 || track.channel.interpolation == GltfInterpolation::kStep) return from;
  const double to = Get(track, place.key + 1, kValue, component);
  const double t = place.share;
  if (track.channel.interpolation == GltfInterpolation::kLinear) return from + (to - from) * t;
  // glTF 2.0, appendix C: tangents are changes per second.
  const double leaves = place.step_seconds * Get(track, place.key, kOutTangent, component);
  const double arrives = place.step_seconds * Get(track, place.key + 1, kInTangent, component);
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * from + (t3 - 2 * t2 + t) * leaves + (-2 * t3 + 3 * t2) * to +
         (t3 - t2) * arrives;
}

}  // namespace

absl::StatusOr<GltfTrack> GltfTrack::Read(const GltfChannel& channel, GltfBuffers* buffers) {
  const std::size_t components = ComponentsOf(channel);
  absl::StatusOr<std::vector<float>> times = buffers->Read(channel.times, 1);
  if (!times.ok()) return times.status();
  absl::StatusOr<std::vector<float>> values =
      buffers->Read(channel.values, static_cast<int>(components));
  if (!values.ok()) return values.status();
  const std::size_t parts = channel.interpolation == GltfInterpolation::kCubicSpline ? 3 : 1;
  if (times->empty() || values->size() != times->size() * parts * components) {
    return absl::InvalidArgumentError(
        absl::StrCat("accessors[", channel.values, "]: expected ", parts,
                     " values for each of at least 1 key, got ", values->size() / components,
                     " for ", times->size(), " keys"));
  }
  if (std::adjacent_find(times->begin(), times->end(), std::greater_equal<float>()) !=
      times->end()) {
    return absl::InvalidArgumentError(
        absl::StrCat("accessors[", channel.times, "]: expected increasing times, got others"));
  }
  return GltfTrack{channel, *std::move(times), *std::move(values)};
}

Vec3d GltfTrack::VectorAt(double seconds) const {
  const KeyPlace place = FindKey(*this, seconds);
  return {Interpolate(*this, place, 0), Interpolate(*this, place, 1), Interpolate(*this, place, 2)};
}

Quaternion GltfTrack::RotationAt(double seconds) const {
  const KeyPlace place = FindKey(*this, seconds);
  const auto key = [this](std::size_t k) {
    return Normalised({Get(*this, k, kValue, 3), Get(*this, k, kValue, 0), Get(*this, k, kValue, 1),
                       Get(*this, k, kValue, 2)});
  };
  if (channel.interpolation == GltfInterpolation::kLinear && place.share > 0) {
    return Slerp(key(place.key), key(place.key + 1), place.share);
  }
  return Normalised({Interpolate(*this, place, 3), Interpolate(*this, place, 0),
                     Interpolate(*this, place, 1), Interpolate(*this, place, 2)});
}

}  // namespace duet::formats::gltf
