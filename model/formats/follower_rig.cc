#include "model/formats/follower_rig.h"

#include <optional>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_rig.h"
#include "model/formats/gltf/gltf_rig.h"
#include "model/motion/motion_limits.h"

namespace duet::formats {
namespace {

bool IsGltf(Format format) { return format == Format::kGltf || format == Format::kGlb; }

retargeting::CharacterOptions CharacterOptionsOf(const ReadOptions& reading) {
  retargeting::CharacterOptions options;
  options.skeleton = reading.skeleton;
  options.joint_overrides = reading.joint_overrides;
  options.metres_per_unit = reading.metres_per_unit;
  if (reading.coordinates.has_value()) options.up_axis = reading.coordinates->up_axis;
  return options;
}

int PersonOf(const ReadOptions& reading) { return reading.side == Side::kLeft ? 0 : 1; }

absl::StatusOr<std::string> OntoBvh(const motion::Clip& follower, const std::string& text,
                                    const FollowerRig& rig, const WriteOptions& writing) {
  const std::string source = rig.file.string();
  const absl::StatusOr<bvh::BvhDocument> document = bvh::ParseBvh(text, source);
  if (!document.ok()) return document.status();
  const bvh::BvhImportOptions options{CharacterOptionsOf(rig.reading), PersonOf(rig.reading)};
  const absl::StatusOr<bvh::BvhDocument> written =
      OntoBvhRig(follower, *document, source, options, {writing.bvh_keys_per_frame, writing.notes});
  if (!written.ok()) return written.status();
  return FormatBvh(*written);
}

absl::StatusOr<std::string> OntoGltf(const motion::Clip& follower, const std::string& content,
                                     const FollowerRig& rig, Format format) {
  gltf::GltfImportOptions options;
  static_cast<retargeting::CharacterOptions&>(options) = CharacterOptionsOf(rig.reading);
  options.person = PersonOf(rig.reading);
  const auto read_beside = [&rig](const std::string& name) {
    return base::ReadFile(rig.file.parent_path() / name, motion::kMaxMotionFileBytes, "a buffer");
  };
  return gltf::OntoGltfRig(
      follower, content, rig.file.string(), read_beside, options,
      format == Format::kGlb ? gltf::GltfContainer::kBinary : gltf::GltfContainer::kText);
}

}  // namespace

bool FitsRig(Format written, Format rig) {
  return (written == Format::kBvh && rig == Format::kBvh) || (IsGltf(written) && IsGltf(rig));
}

absl::StatusOr<std::string> FormatOntoRig(const motion::Clip& follower, const FollowerRig& rig,
                                          Format format, const WriteOptions& options) {
  const std::optional<Format> rigs = FormatOf(rig.file);
  if (!rigs.has_value() || !FitsRig(format, *rigs)) {
    return absl::InvalidArgumentError(absl::StrCat(
        rig.file.string(), ": rig: wanted a .bvh for a .bvh, a .glb or .gltf for either of these"));
  }
  const absl::StatusOr<std::string> content =
      base::ReadFile(rig.file, motion::kMaxMotionFileBytes, "a rig");
  if (!content.ok()) return content.status();
  return format == Format::kBvh ? OntoBvh(follower, *content, rig, options)
                                : OntoGltf(follower, *content, rig, format);
}

}  // namespace duet::formats
