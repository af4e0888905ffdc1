#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_TRACK_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_TRACK_H_

#include <cstddef>
#include <vector>

#include "absl/status/statusor.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/retargeting/rotation.h"

namespace duet::formats::gltf {

// One property of a node over time, with its values in memory. It is constant before the first key
// and after the last one.
class GltfTrack {
 public:
  // Errors: INVALID_ARGUMENT if times do not increase, the number of values does not match the
  //         keys, or there is no key; those of GltfBuffers.
  static absl::StatusOr<GltfTrack> Read(const GltfChannel& channel, GltfBuffers* buffers);

  const GltfChannel& channel() const { return channel_; }
  const std::vector<float>& times() const { return times_; }  // seconds, increasing

  // Requires a translation or scale.
  retargeting::Vec3d VectorAt(double seconds) const;
  // Requires a rotation. Interpolates along the shorter arc; returns a unit quaternion.
  retargeting::Quaternion RotationAt(double seconds) const;

 private:
  // A time relative to the keys: the last key before it and the fraction of the step to the next.
  struct Place {
    std::size_t key = 0;
    double share = 0;
    double step_seconds = 0;
  };
  Place Find(double seconds) const;
  // A component of a key's value, or of a tangent of a spline.
  enum Part { kInTangent, kValue, kOutTangent };
  double Get(std::size_t key, Part part, std::size_t component) const;
  // Interpolates one component.
  double Interpolate(const Place& place, std::size_t component) const;

  GltfChannel channel_;
  std::size_t components_ = 0;
  std::vector<float> times_;   // [keys]
  std::vector<float> values_;  // [keys, components]; splines: [keys, 3 parts, components]
};

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_TRACK_H_
