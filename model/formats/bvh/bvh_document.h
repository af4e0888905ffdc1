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

// The number of decimals of a number such as ".0333"; absent for one in another notation.
std::optional<int> DecimalsOf(absl::string_view number);

// The rate in Hz that a written frame time stands for. Exporters round: .0333 is 1/30, .0167 is
// 1/60, .0083 is 1/120. In this order:
//
// - an integer whose frame time this is;
// - the common rate nearest to it (24, 30, 60, ...) whose frame time has these decimals, rounded,
// or
//   of four decimals and more also truncated;
// - an integer within half a per mille;
// - a broadcast rate (29.97, 59.94) whose frame time has these decimals;
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

// The meaning of position channels of joints below the root. Programs write both kinds; a file uses
// only one.
enum class PositionChannels {
  kReplaceOffset,  // the joint's offset from its parent
  kAddToOffset,    // its difference from OFFSET
};

// Infers the meaning of a file's position channels from all joints and frames: bones hardly change
// their length, so values near OFFSET replace it and values near zero add to it. Each joint has one
// vote from -1 to 1. A pelvis that moves freely below a fixed root has a vote near 0. Returns
// kReplaceOffset if the votes are even. Absent if both mean the same: no joint below a root has
// position channels and an OFFSET.
std::optional<PositionChannels> FindPositionChannels(const BvhDocument& document);

// Computes the joint positions of a frame by forward kinematics, in the file's unit.
//
// The rotations of a joint apply in the order of its channels, with the first one outermost. A
// root's position channels replace OFFSET; FindPositionChannels determines the meaning of the
// others.
class BvhKinematics {
 public:
  // `document` must outlive the kinematics.
  explicit BvhKinematics(const BvhDocument& document);
  std::vector<retargeting::Vec3d> Positions(int frame) const { return PoseAt(frame).positions; }

  // Positions and the rotations of the joints' axes, in the file's axes. [joints]
  struct Pose {
    std::vector<retargeting::Vec3d> positions;
    std::vector<retargeting::Quaternion> rotations;
  };
  Pose PoseAt(int frame) const;

 private:
  struct Local {
    retargeting::Vec3d translation;
    retargeting::Quaternion rotation;
  };
  Local LocalTransform(std::size_t joint, const float* values) const;

  const BvhDocument& document_;
  bool adds_to_offset_ = false;  // of joints below the root
};

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_DOCUMENT_H_
