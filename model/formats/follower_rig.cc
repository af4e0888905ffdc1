#include "model/formats/follower_rig.h"

#include "model/base/file.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_rig.h"
#include "model/motion/motion_limits.h"

namespace duet::formats {

absl::StatusOr<std::string> FormatOntoRig(const motion::Clip& follower, const FollowerRig& rig) {
  const absl::StatusOr<std::string> text =
      base::ReadFile(rig.file, motion::kMaxMotionFileBytes, "a rig");
  if (!text.ok()) return text.status();
  const std::string source = rig.file.string();
  const absl::StatusOr<bvh::BvhDocument> document = bvh::ParseBvh(*text, source);
  if (!document.ok()) return document.status();
  bvh::BvhImportOptions options;
  options.skeleton = rig.reading.skeleton;
  options.joint_overrides = rig.reading.joint_overrides;
  options.metres_per_unit = rig.reading.metres_per_unit;
  if (rig.reading.coordinates.has_value()) options.up_axis = rig.reading.coordinates->up_axis;
  options.person = rig.reading.side == Side::kLeft ? 0 : 1;
  const absl::StatusOr<bvh::BvhDocument> written = OntoBvhRig(follower, *document, source, options);
  if (!written.ok()) return written.status();
  return FormatBvh(*written);
}

}  // namespace duet::formats
