#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_PUPPET_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_PUPPET_H_

#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/motion/vec3.h"
#include "model/retargeting/joint_mapping.h"
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

// The nodes of a character and their ancestors.
struct Members {
  std::vector<int> above;  // from the outermost one to the root's parent
  std::vector<int> nodes;  // the root and all below it, parents first
};

// The times of the first and last keys of all tracks, and the rate of keys.
struct Timing {
  double start = 0, end = 0;
  double rate_hz = 0;
};

// The nodes of a character with their tracks.
class Puppet {
 public:
  // `document` must outlive this object.
  Puppet(const GltfDocument& document, Members members);

  const Members& members() const { return members_; }
  bool IsMovedBy(const GltfAnimation& animation) const;

  // Replaces the tracks. Errors: those of GltfTrack::Read.
  absl::Status ReadTracks(const GltfAnimation& animation, GltfBuffers* buffers);

  // Hand-keyed animations, whose keys are far apart, have a rate of 30 Hz.
  Timing FindTiming() const;

  // The rest pose: lengths in the world's unit, each bone in its parent's axes.
  retargeting::JointTree Tree();
  // The places of the members in the world.
  std::vector<motion::Vec3> PoseAt(double seconds);

  // How far the joints move from where they start: the mean of their largest distances, as a
  // fraction of the character's size.
  double Travel();

 private:
  // The parts of a node's transform that tracks move, and those that they do not.
  retargeting::Parts PartsAt(int node, double seconds) const;
  // The transform in the parent's axes; at rest if `seconds` is absent.
  retargeting::Affine Local(int node, std::optional<double> seconds) const;
  void Stand(std::optional<double> seconds);

  const GltfDocument* document_;
  Members members_;
  std::vector<std::vector<GltfTrack>> tracks_;  // [nodes]
  std::vector<bool> is_member_;                 // [nodes]
  std::vector<bool> moves_;                     // [nodes], members and their ancestors
  std::vector<retargeting::Affine> world_;      // [nodes]
};

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_PUPPET_H_
