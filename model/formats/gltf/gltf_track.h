#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_TRACK_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_TRACK_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/retargeting/rotation.h"

namespace duet::formats::gltf {

// One property of a node over time, with its values in memory. It is constant before the first key
// and after the last one.
struct GltfTrack {
  // Errors: INVALID_ARGUMENT if times do not increase, the number of values does not match the
  //         keys, or there is no key; those of GltfBuffers.
  static absl::StatusOr<GltfTrack> Read(const GltfChannel& channel, GltfBuffers* buffers);

  // Requires a translation or scale.
  retargeting::Vec3d VectorAt(double seconds) const;
  // Requires a rotation. Interpolates along the shorter arc; returns a unit quaternion.
  retargeting::Quaternion RotationAt(double seconds) const;

  GltfChannel channel;
  std::vector<float> times;   // [keys], seconds, increasing
  std::vector<float> values;  // [keys, components]; splines: [keys, 3 parts, components]
};

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_TRACK_H_
