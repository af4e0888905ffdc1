#include "model/formats/follower_rig.h"

#include <optional>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "model/formats/asf/amc_import.h"
#include "model/formats/bvh/bvh_character.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_rig.h"
#include "model/formats/fbx/fbx_rig.h"
#include "model/formats/file_beside.h"
#include "model/formats/format_options.h"
#include "model/formats/gltf/gltf_character.h"
#include "model/formats/gltf/gltf_rig.h"
#include "model/motion/motion_limits.h"
#include "model/retargeting/rig_transfer.h"

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

fbx::FbxImportOptions FbxOptionsOf(const FollowerRig& rig) {
  return {RigOptionsOf(rig), PersonOf(rig.reading), std::nullopt, std::nullopt};
}

gltf::GltfFileReader FilesBeside(const FollowerRig& rig) {
  return [rig_file = rig.file](const std::string& name) {
    return ReadFileBeside(rig_file, name, "a buffer");
  };
}

gltf::GltfContainer ContainerOf(Format format) {
  return format == Format::kGlb ? gltf::GltfContainer::kBinary : gltf::GltfContainer::kText;
}

bvh::BvhKeys KeysOf(const WriteOptions& writing) {
  return {writing.bvh_keys_per_frame, writing.notes};
}

// In the rig's own format, everything in its file except the motion is kept.
absl::StatusOr<std::string> OntoBvh(const motion::Clip& follower, const std::string& text,
                                    const FollowerRig& rig, const WriteOptions& writing) {
  const std::string source = rig.file.string();
  const absl::StatusOr<bvh::BvhDocument> document = bvh::ParseBvh(text, source);
  if (!document.ok()) return document.status();
  const absl::StatusOr<bvh::BvhDocument> written =
      OntoBvhRig(follower, *document, source, BvhOptionsOf(rig), KeysOf(writing));
  if (!written.ok()) return written.status();
  return FormatBvh(*written);
}

absl::StatusOr<retargeting::CharacterRig> ReadBvhRig(const std::string& text,
                                                     const FollowerRig& rig) {
  const absl::StatusOr<bvh::BvhDocument> document = bvh::ParseBvh(text, rig.file.string());
  if (!document.ok()) return document.status();
  return BvhRig(*document, rig.file.string(), BvhOptionsOf(rig));
}

absl::StatusOr<retargeting::CharacterRig> ReadAmcRig(const std::string& text,
                                                     const FollowerRig& rig) {
  const absl::StatusOr<asf::AsfSkeleton> skeleton = asf::ReadSkeletonBeside(rig.file);
  if (!skeleton.ok()) return skeleton.status();
  const std::string source = rig.file.string();
  const absl::StatusOr<asf::AmcMotion> motion = asf::ParseAmc(text, source, *skeleton);
  if (!motion.ok()) return motion.status();
  return AmcRig(*skeleton, *motion, source, {RigOptionsOf(rig), std::nullopt});
}

// In another format, joints and bones are kept.
absl::StatusOr<std::string> OntoRig(const motion::Clip& follower,
                                    const retargeting::CharacterRig& rig, const std::string& source,
                                    Format format, const WriteOptions& writing) {
  const absl::StatusOr<std::vector<retargeting::CharacterPose>> poses =
      TransferToRig(follower, rig, source);
  if (!poses.ok()) return poses.status();
  if (format == Format::kBvh) {
    return FormatBvh(bvh::ToBvh(rig, *poses, follower.frame_rate_hz, writing.bvh_metres_per_unit,
                                KeysOf(writing)));
  }
  return gltf::FormatCharacter(rig, *poses, follower.frame_rate_hz, writing.provenance,
                               ContainerOf(format));
}

absl::StatusOr<retargeting::CharacterRig> ReadRig(Format format, const std::string& content,
                                                  const FollowerRig& rig) {
  if (format == Format::kBvh) return ReadBvhRig(content, rig);
  if (format == Format::kAmc) return ReadAmcRig(content, rig);
  if (format == Format::kFbx) {
    return fbx::ReadFbxRig(content, rig.file.string(), FbxOptionsOf(rig));
  }
  return gltf::ReadGltfRig(content, rig.file.string(), FilesBeside(rig), GltfOptionsOf(rig));
}

absl::StatusOr<std::string> ReadRigFile(const FollowerRig& rig) {
  return base::ReadFile(rig.file, motion::kMaxMotionFileBytes, "a rig");
}

}  // namespace

bool FitsRig(Format written, Format rig) {
  const bool is_rig =
      rig == Format::kBvh || rig == Format::kAmc || rig == Format::kFbx || IsGltf(rig);
  return is_rig && (written == Format::kBvh || IsGltf(written));
}

absl::Status CheckRig(const FollowerRig& rig) {
  const std::optional<Format> format = FormatOf(rig.file);
  if (!format.has_value() || !FitsRig(Format::kBvh, *format)) {
    return absl::InvalidArgumentError(
        absl::StrCat(rig.file.string(), ": rig: expected ", kRigExtensions));
  }
  const absl::StatusOr<std::string> content = ReadRigFile(rig);
  if (!content.ok()) return content.status();
  return ReadRig(*format, *content, rig).status();
}

absl::StatusOr<double> BvhUnitOnRig(const FollowerRig& rig, const WriteOptions& options) {
  if (FormatOf(rig.file) != Format::kBvh) return options.bvh_metres_per_unit;
  const absl::StatusOr<std::string> content = ReadRigFile(rig);
  if (!content.ok()) return content.status();
  const absl::StatusOr<bvh::BvhDocument> document = bvh::ParseBvh(*content, rig.file.string());
  if (!document.ok()) return document.status();
  retargeting::CharacterFit fit;
  bvh::BvhImportOptions reading = BvhOptionsOf(rig);
  reading.fit = &fit;
  reading.notes = nullptr;
  reading.report = nullptr;
  const absl::StatusOr<motion::Clip> read = FromBvh(*document, rig.file.string(), reading);
  if (!read.ok()) return read.status();
  return fit.metres_per_unit;
}

absl::StatusOr<std::string> FormatOntoRig(const motion::Clip& follower, const FollowerRig& rig,
                                          Format format, const WriteOptions& options) {
  const std::string source = rig.file.string();
  const std::optional<Format> rigs = FormatOf(rig.file);
  if (!rigs.has_value() || !FitsRig(format, *rigs)) {
    return absl::InvalidArgumentError(absl::StrCat(source, ": rig: expected ", kRigExtensions,
                                                   "; it is written as ", kRigOutputExtensions));
  }
  const absl::StatusOr<std::string> content = ReadRigFile(rig);
  if (!content.ok()) return content.status();
  if (format == Format::kBvh && *rigs == Format::kBvh) {
    return OntoBvh(follower, *content, rig, options);
  }
  if (IsGltf(format) && IsGltf(*rigs)) {
    return gltf::OntoGltfRig(follower, *content, source, FilesBeside(rig), GltfOptionsOf(rig),
                             ContainerOf(format));
  }
  if (IsGltf(format) && *rigs == Format::kFbx) {
    return fbx::OntoFbxRig(follower, *content, source, FbxOptionsOf(rig), ContainerOf(format));
  }
  const absl::StatusOr<retargeting::CharacterRig> read = ReadRig(*rigs, *content, rig);
  if (!read.ok()) return read.status();
  return OntoRig(follower, *read, source, format, options);
}

}  // namespace duet::formats
