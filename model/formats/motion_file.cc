#include "model/formats/motion_file.h"

#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/types/span.h"
#include "model/base/file.h"
#include "model/base/text.h"
#include "model/formats/asf/amc_import.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_export.h"
#include "model/formats/bvh/bvh_import.h"
#include "model/formats/flat/csv.h"
#include "model/formats/flat/json_motion.h"
#include "model/formats/flat/npy.h"
#include "model/formats/flat/sbu_text.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/formats/gltf/gltf_import.h"
#include "model/motion/motion_limits.h"
#include "model/motion/reading_setting.h"
#include "model/motion/recorded_motion.h"
#include "model/retargeting/character.h"

namespace duet::formats {
namespace {

namespace fs = std::filesystem;

constexpr double kSbuFrameRateHz = 15;

enum class Format { kSbuText, kBvh, kCsv, kNpy, kJson, kGltf, kAmc, kUnknown };

Format FormatOf(const fs::path& path) {
  const std::string extension = absl::AsciiStrToLower(path.extension().string());
  if (extension == ".txt") return Format::kSbuText;
  if (extension == ".bvh") return Format::kBvh;
  if (extension == ".csv") return Format::kCsv;
  if (extension == ".npy") return Format::kNpy;
  if (extension == ".json") return Format::kJson;
  if (extension == ".gltf" || extension == ".glb") return Format::kGltf;
  if (extension == ".amc") return Format::kAmc;
  return Format::kUnknown;
}

// Positions alone do not say which axis is up where nobody does: Blender's is z.
void WarnOfUpAxis(const motion::Clip& clip, const motion::Skeleton& skeleton,
                  std::vector<std::string>* notes) {
  const std::optional<motion::UpAxis> up = retargeting::FindUpAxis(clip, skeleton);
  if (!up.has_value() || *up == motion::UpAxis::kYUp) return;
  notes->push_back(absl::StrCat(
      "warning: up axis: as the file was read, the feet are not below the root along y; ",
      motion::UpAxisName(*up), " would fit; say which axis is up"));
}

// The joints of a file with positions as the skeleton's, in metres, y up.
absl::StatusOr<motion::Clip> ToSkeleton(const motion::RecordedMotion& motion,
                                        const std::string& source, const ReadOptions& options) {
  const bool second = options.side == Side::kRight && motion.people.size() > 1;
  const motion::Clip& person = motion.people[second ? 1 : 0];
  absl::StatusOr<retargeting::JointMap> map = retargeting::MapJoints(
      source, person.joint_names, person.poses, options.skeleton, options.joint_overrides);
  if (!map.ok()) return map.status();
  if (options.notes != nullptr) {
    options.notes->insert(options.notes->end(), map->notes.begin(), map->notes.end());
  }
  const motion::Coordinates coordinates = options.coordinates.value_or(motion.coordinates);
  motion::Clip clip;
  clip.joint_names = options.skeleton.joint_names;
  clip.frame_rate_hz = person.frame_rate_hz;
  for (int frame = 0; frame < person.frame_count(); ++frame) {
    std::vector<motion::Vec3> pose = ApplyJointMap(*map, person.poses[frame]);
    for (motion::Vec3& position : pose) position = ToWorld(coordinates, position);
    clip.Append(pose);
  }
  if (options.notes != nullptr && !options.coordinates.has_value()) {
    WarnOfUpAxis(clip, options.skeleton, options.notes);
  }
  return clip;
}

absl::StatusOr<motion::Clip> ReadSbuPerson(const std::string& text, const std::string& source,
                                           const ReadOptions& options) {
  flat::SbuOptions sbu;
  sbu.joint_names = options.skeleton.joint_names;
  sbu.frame_rate_hz = options.frame_rate_hz.value_or(kSbuFrameRateHz);
  sbu.coordinates = options.coordinates.value_or(sbu.coordinates);
  absl::StatusOr<flat::SbuRecording> recording = ParseSbu(text, source, sbu);
  if (!recording.ok()) return recording.status();
  return options.side == Side::kLeft ? std::move(recording->left) : std::move(recording->right);
}

// Left is the first person of a file.
int PersonOf(const ReadOptions& options) { return options.side == Side::kLeft ? 0 : 1; }

retargeting::CharacterOptions CharacterOptionsOf(const ReadOptions& options) {
  retargeting::CharacterOptions character;
  character.skeleton = options.skeleton;
  character.joint_overrides = options.joint_overrides;
  character.metres_per_unit = options.metres_per_unit;
  if (options.coordinates.has_value()) character.up_axis = options.coordinates->up_axis;
  character.notes = options.notes;
  return character;
}

absl::StatusOr<motion::Clip> ReadBvhPerson(const std::string& text, const std::string& source,
                                           const ReadOptions& options) {
  absl::StatusOr<bvh::BvhDocument> document = bvh::ParseBvh(text, source);
  if (!document.ok()) return document.status();
  bvh::BvhImportOptions bvh{CharacterOptionsOf(options), PersonOf(options)};
  return FromBvh(*document, source, bvh);
}

absl::StatusOr<motion::Clip> ReadGltfPerson(const std::string& content, const fs::path& path,
                                            const ReadOptions& options) {
  absl::StatusOr<gltf::GltfDocument> document = gltf::ParseGltf(content, path.string());
  if (!document.ok()) return document.status();
  gltf::GltfImportOptions gltf{CharacterOptionsOf(options), PersonOf(options),
                               options.frame_rate_hz};
  const auto read_beside = [&path](const std::string& name) {
    return base::ReadFile(path.parent_path() / name, motion::kMaxMotionFileBytes, "a buffer");
  };
  return FromGltf(*document, path.string(), read_beside, gltf);
}

// The skeleton of a motion lies beside it.
absl::StatusOr<asf::AsfSkeleton> ReadAsfBeside(const fs::path& path) {
  const std::vector<std::string> names = asf::SkeletonNames(path.filename().string());
  for (const std::string& name : names) {
    const fs::path skeleton = path.parent_path() / name;
    const absl::StatusOr<std::string> text =
        base::ReadFile(skeleton, motion::kMaxMotionFileBytes, "a skeleton");
    if (absl::IsNotFound(text.status())) continue;
    if (!text.ok()) return text.status();
    return asf::ParseAsf(*text, skeleton.string());
  }
  return absl::NotFoundError(absl::StrCat(path.string(), ": skeleton: wanted ",
                                          absl::StrJoin(names, " or "), " in the same folder"));
}

absl::StatusOr<motion::Clip> ReadAmcPerson(const std::string& text, const fs::path& path,
                                           const ReadOptions& options) {
  const absl::StatusOr<asf::AsfSkeleton> skeleton = ReadAsfBeside(path);
  if (!skeleton.ok()) return skeleton.status();
  const absl::StatusOr<asf::AmcMotion> motion = asf::ParseAmc(text, path.string(), *skeleton);
  if (!motion.ok()) return motion.status();
  const asf::AmcImportOptions amc{CharacterOptionsOf(options), options.frame_rate_hz};
  return FromAmc(*skeleton, *motion, path.string(), amc);
}

absl::StatusOr<motion::Clip> ReadPerson(const fs::path& path, const std::string& content,
                                        const ReadOptions& options) {
  const Format format = FormatOf(path);
  const std::string source = path.string();
  if (format == Format::kGltf) return ReadGltfPerson(content, path, options);
  if (format == Format::kAmc) return ReadAmcPerson(content, path, options);
  if (format == Format::kSbuText) return ReadSbuPerson(content, source, options);
  if (format == Format::kBvh) return ReadBvhPerson(content, source, options);
  absl::StatusOr<motion::RecordedMotion> motion =
      format == Format::kCsv   ? flat::ParseCsv(content, source)
      : format == Format::kNpy ? flat::ParseNpy(content, source, options.skeleton.joint_names)
                               : flat::ParseJsonMotion(content, source);
  if (!motion.ok()) return motion.status();
  return ToSkeleton(*motion, source, options);
}

absl::Status WriteBvh(const fs::path& path, const motion::Clip& clip,
                      const motion::Skeleton& skeleton) {
  absl::StatusOr<bvh::BvhDocument> document = bvh::ToBvh(clip, skeleton);
  if (!document.ok()) return document.status();
  return base::WriteFile(path, FormatBvh(*document));
}

absl::StatusOr<std::vector<fs::path>> WriteBvhPair(const fs::path& path,
                                                   const motion::ClipPair& pair,
                                                   const motion::Skeleton& skeleton) {
  fs::path leader = path, follower = path;
  leader.replace_extension(".leader.bvh");
  follower.replace_extension(".follower.bvh");
  absl::Status status = WriteBvh(leader, pair.leader, skeleton);
  if (status.ok()) status = WriteBvh(follower, pair.follower, skeleton);
  if (!status.ok()) return status;
  return std::vector<fs::path>{leader, follower};
}

absl::Status CheckJoints(const motion::ClipPair& pair, const motion::Skeleton& skeleton) {
  if (pair.leader.joint_names == skeleton.joint_names) return CheckPair(pair);
  return absl::InvalidArgumentError(absl::StrCat("pair: came ", pair.leader.joint_count(),
                                                 " joints, wanted the skeleton's ",
                                                 skeleton.joint_count(), " in its order"));
}

}  // namespace

bool IsReadable(const fs::path& path) { return FormatOf(path) != Format::kUnknown; }

bool IsWritable(const fs::path& path) {
  const Format format = FormatOf(path);
  return IsReadable(path) && format != Format::kSbuText && format != Format::kGltf &&
         format != Format::kAmc;
}

absl::Status UnknownExtension(const fs::path& path, absl::string_view known) {
  return absl::InvalidArgumentError(absl::StrCat(path.string(), ": extension: came ",
                                                 base::Quoted(path.extension().string()),
                                                 ", wanted ", known));
}

absl::StatusOr<motion::Clip> ReadLeader(const fs::path& path, const ReadOptions& options) {
  if (!IsReadable(path)) return UnknownExtension(path, kReadableExtensions);
  if (options.frame_rate_hz.has_value()) {
    absl::Status status = motion::CheckFrameRate("frame rate given", *options.frame_rate_hz);
    if (!status.ok()) return status;
  }
  absl::StatusOr<std::string> content =
      base::ReadFile(path, motion::kMaxMotionFileBytes, "a motion");
  if (!content.ok()) return content.status();
  absl::StatusOr<motion::Clip> clip = ReadPerson(path, *content, options);
  if (!clip.ok()) return clip.status();
  if (options.frame_rate_hz.has_value()) clip->frame_rate_hz = *options.frame_rate_hz;
  if (clip->frame_rate_hz > 0) return clip;
  return MendedBy(absl::InvalidArgumentError(absl::StrCat(
                      path.string(), ": frame rate: the file has none, wanted one beside it")),
                  motion::ReadingSetting::kFrameRate);
}

absl::StatusOr<std::vector<motion::Vec3>> ReadFollowerStart(const fs::path& path,
                                                            const ReadOptions& options) {
  ReadOptions any_rate = options;
  // A single pose has no rate; a file without one will do.
  if (!any_rate.frame_rate_hz.has_value()) any_rate.frame_rate_hz = kSbuFrameRateHz;
  absl::StatusOr<motion::Clip> clip = ReadLeader(path, any_rate);
  if (!clip.ok()) return clip.status();
  const absl::Span<const motion::Vec3> start = clip->poses[0];
  return std::vector<motion::Vec3>(start.begin(), start.end());
}

absl::StatusOr<std::vector<fs::path>> WritePair(const fs::path& path, const motion::ClipPair& pair,
                                                const motion::Skeleton& skeleton) {
  if (!IsWritable(path)) return UnknownExtension(path, kWritableExtensions);
  absl::Status status = CheckJoints(pair, skeleton);
  if (!status.ok()) return status;
  const Format format = FormatOf(path);
  if (format == Format::kBvh) return WriteBvhPair(path, pair, skeleton);
  status = base::WriteFile(path, format == Format::kCsv   ? flat::FormatCsv(pair)
                                 : format == Format::kNpy ? flat::FormatNpy(pair)
                                                          : flat::FormatJsonMotion(pair, skeleton));
  if (!status.ok()) return status;
  return std::vector<fs::path>{path};
}

}  // namespace duet::formats
