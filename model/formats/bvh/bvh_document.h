#ifndef DUET_MODEL_FORMATS_BVH_BVH_DOCUMENT_H_
#define DUET_MODEL_FORMATS_BVH_BVH_DOCUMENT_H_

#include <cstddef>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/retargeting/rotation.h"

namespace duet::formats::bvh {

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

// A BVH file as it stands: the hierarchy in the file's order and every channel of every frame.
//
// Units: lengths in the file's own unit, angles in degrees.
struct BvhDocument {
  std::vector<BvhJoint> joints;
  double frame_time_s = 0;
  int frame_count = 0;
  std::vector<float> values;  // [frame_count, channels of all joints in order]

  int ChannelCount() const;
};

// Reads any hierarchy with any channels in any order; several ROOTs are allowed.
// Errors: INVALID_ARGUMENT "source:line: ... came ..., wanted ...".
absl::StatusOr<BvhDocument> ParseBvh(absl::string_view text, absl::string_view source);

// Writes what ParseBvh reads. The document's joints come depth first, as ParseBvh gives them.
std::string FormatBvh(const BvhDocument& document);

// Joint positions of one frame through forward kinematics, in the file's unit. [joints]
//
// The rotations of a joint apply in the order in which its channels are written, the first one
// outermost. Position channels stand in place of OFFSET; below the root they count as an addition
// to it where the first frame's values are nearer to zero than to OFFSET (both kinds are written).
class BvhKinematics {
 public:
  explicit BvhKinematics(const BvhDocument& document);
  std::vector<retargeting::Vec3d> Positions(int frame) const;

 private:
  struct Local {
    retargeting::Vec3d translation;
    retargeting::Quaternion rotation;
  };
  Local LocalTransform(std::size_t joint, const float* values) const;

  const BvhDocument& document_;
  std::vector<bool> adds_to_offset_;  // [joints]
};

}  // namespace duet::formats::bvh

#endif  // DUET_MODEL_FORMATS_BVH_BVH_DOCUMENT_H_
