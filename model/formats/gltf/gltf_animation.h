#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_ANIMATION_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_ANIMATION_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/formats/gltf/gltf_buffers.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/retargeting/rotation.h"

namespace duet::formats::gltf {

// One property of a node over time, with its values at hand. Before the first key and after the
// last one it stays.
class GltfTrack {
 public:
  // Errors: INVALID_ARGUMENT for times that do not rise, another number of values than keys, no
  //         key, and what GltfBuffers says.
  static absl::StatusOr<GltfTrack> Read(const GltfChannel& channel, GltfBuffers* buffers);

  const GltfChannel& channel() const { return channel_; }
  const std::vector<float>& times() const { return times_; }  // seconds, rising

  // Of a translation or scale.
  retargeting::Vec3d VectorAt(double seconds) const;
  // Of a rotation: along the shorter arc, at length 1.
  retargeting::Quaternion RotationAt(double seconds) const;

 private:
  // Where a moment is among the keys: `key` and the share of the way to the next one.
  struct Place {
    std::size_t key = 0;
    double share = 0;
    double step_seconds = 0;
  };
  Place Find(double seconds) const;
  // A component of a key's value, or of its tangents where the track has some.
  enum Part { kInTangent, kValue, kOutTangent };
  double Get(std::size_t key, Part part, std::size_t component) const;
  // The component at a place, each on its own: steps, lines or splines.
  double Interpolate(const Place& place, std::size_t component) const;

  GltfChannel channel_;
  std::size_t components_ = 0;
  std::vector<float> times_;   // [keys]
  std::vector<float> values_;  // [keys, components], or [keys, 3 parts, components] of splines
};

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_ANIMATION_H_
