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

// What the position channels of joints below the root say. Both kinds are written, and a file is of
// one kind throughout.
enum class PositionChannels {
  kReplaceOffset,  // the joint's place from its parent
  kAddToOffset,    // how far from OFFSET it is
};

// How one file's position channels are to be read, from all of its joints and frames: bones hardly
// change their length, so values that stay at OFFSET replace it and values that stay at zero add to
// it. Each joint has one vote, from -1 to 1; a pelvis below a root that stands still moves freely
// and says little. kReplaceOffset where nothing speaks for either. Absent where both come to the
// same: no joint below a root has position channels and an OFFSET.
std::optional<PositionChannels> FindPositionChannels(const BvhDocument& document);

// Joint positions of one frame through forward kinematics, in the file's unit. [joints]
//
// The rotations of a joint apply in the order in which its channels are written, the first one
// outermost. A root's position channels stand in place of OFFSET, those of the other joints as
// FindPositionChannels has it.
class BvhKinematics {
 public:
  // `document` outlives the kinematics.
  explicit BvhKinematics(const BvhDocument& document);
  std::vector<retargeting::Vec3d> Positions(int frame) const;

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
