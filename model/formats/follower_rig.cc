#include "model/formats/follower_rig.h"

#include <optional>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_motion.h"
#include "model/formats/gltf/gltf_motion.h"
#include "model/formats/reading.h"
#include "model/motion/motion_limits.h"

namespace duet::formats {
namespace {

// The feet of a rig may lack toes.
retargeting::CharacterOptions RigOptionsOf(const FollowerRig& rig) {
  retargeting::CharacterOptions options = CharacterOptionsOf(rig.reading);
  options.missing_toes = retargeting::MissingToes::kAtTheFeet;
  return options;
}

bvh::BvhImportOptions BvhOptionsOf(const FollowerRig& rig) {
  return {RigOptionsOf(rig), PersonOf(rig.reading)};
}

gltf::GltfImportOptions GltfOptionsOf(const FollowerRig& rig) {
  return {RigOptionsOf(rig), PersonOf(rig.reading), std::nullopt};
}

gltf::GltfFileReader FilesBeside(const FollowerRig& rig) {
  return [rig_file = rig.file](const std::string& name) {
    return ReadFileBeside(rig_file, name, "a buffer");
  };
}

absl::StatusOr<std::string> OntoBvh(const motion::Clip& follower, const std::string& text,
                                    const FollowerRig& rig) {
  const absl::StatusOr<bvh::BvhDocument> document = bvh::ParseBvh(text, rig.file.string());
  if (!document.ok()) return document.status();
  const absl::StatusOr<bvh::BvhDocument> written =
      OntoBvhRig(follower, *document, rig.file.string(), BvhOptionsOf(rig));
  if (!written.ok()) return written.status();
  return FormatBvh(*written);
}

absl::StatusOr<std::string> ReadRigFile(const FollowerRig& rig) {
  return base::ReadFile(rig.file, motion::kMaxMotionFileBytes, "a rig");
}

}  // namespace

bool HasRig(Format format) { return format == Format::kBvh || IsGltf(format); }

bool FitsRig(Format written, Format rig) {
  return HasRig(rig) && (written == rig || (IsGltf(written) && IsGltf(rig)));
}

absl::StatusOr<std::string> FormatOntoRig(const motion::Clip& follower, const FollowerRig& rig,
                                          Format format) {
  const std::string source = rig.file.string();
  const std::optional<Format> format_of_rig = FormatOf(rig.file);
  if (!format_of_rig.has_value() || !FitsRig(format, *format_of_rig)) {
    const std::string how = HowToConvert(rig.file);
    return absl::InvalidArgumentError(
        absl::StrCat(source, ": rig: expected ", kRigExtensions, "; ",
                     how.empty() ? "it is written in its own format" : how));
  }
  const absl::StatusOr<std::string> content = ReadRigFile(rig);
  if (!content.ok()) return content.status();
  if (format == Format::kBvh) return OntoBvh(follower, *content, rig);
  return gltf::OntoGltfRig(
      follower, *content, source, FilesBeside(rig), GltfOptionsOf(rig),
      format == Format::kGlb ? gltf::GltfContainer::kBinary : gltf::GltfContainer::kText);
}

}  // namespace duet::formats
