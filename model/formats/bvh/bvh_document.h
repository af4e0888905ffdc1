#ifndef DUET_MODEL_FORMATS_BVH_BVH_DOCUMENT_H_
#define DUET_MODEL_FORMATS_BVH_BVH_DOCUMENT_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/retargeting/rotation.h"

namespace duet::formats::bvh {

// The rate in Hz that a written frame time stands for. Exporters round: .0333 is 1/30, .0167 is
// 1/60, .0083 is 1/120. In this order:
//
// - an integer whose frame time this is;
// - the common rate nearest to it (24, 30, 60, ...) whose frame time has these decimals, rounded,
//   or of four decimals and more also truncated;
// - an integer within half a per mille;
// - the rate as it is.
double RateOfFrameTime(double seconds, std::optional<int> decimals);

enum class BvhChannel {
  kXPosition,
  kYPosition,
  kZPosition,
  kXRotation,
  kYRotation,
  kZRotation,
};
inline bool IsRotation(BvhChannel channel) { return channel >= BvhChannel::kXRotation; }
// 0 x, 1 y, 2 z.
inline int AxisOf(BvhChannel channel) { return static_cast<int>(channel) % 3; }

// A joint or an End Site; an End Site is named after its joint, "Head" -> "Head.end".
struct BvhJoint {
  std::string name;
  int parent = -1;  // an earlier joint; -1 for a ROOT
  retargeting::Vec3d offset;
  std::vector<BvhChannel> channels;  // in the file's order
  bool end_site = false;
};

// The content of a BVH file: the hierarchy in the file's order and every channel of every frame.
//
// Units: lengths in the file's own unit, angles in degrees.
struct BvhDocument {
  std::vector<BvhJoint> joints;
  double frame_time_s = 0;
  std::optional<int> frame_time_decimals;  // of the number in the file, if it is rounded to some
  int frame_count = 0;
  // The frames that the file states, if there is one more or one fewer.
  std::optional<int> stated_frame_count;
  std::vector<float> values;  // [frame_count, channels of all joints in order]

  int ChannelCount() const;
};

// Parses any hierarchy with any channels in any order. Several ROOTs are allowed.
// Errors: INVALID_ARGUMENT "source:line: ...: expected ..., got ...".
absl::StatusOr<BvhDocument> ParseBvh(absl::string_view text, absl::string_view source);

// The inverse of ParseBvh. Requires joints in depth-first order, as ParseBvh returns them.
std::string FormatBvh(const BvhDocument& document);

// The positions of the joints and the rotations of their axes, in the file's unit and axes.
// [joints]
struct BvhPose {
  std::vector<retargeting::Vec3d> positions;
  std::vector<retargeting::Quaternion> rotations;
};

// Computes the pose of a frame by forward kinematics. The rotations of a joint apply in the order
// of its channels, with the first one outermost. Position channels replace OFFSET.
BvhPose PoseAt(const BvhDocument& document, int frame);

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_DOCUMENT_H_
