#include "model/formats/motion_file.h"

#include <cstddef>
#include <iterator>
#include <map>
#include <system_error>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "model/base/file.h"
#include "model/base/text.h"
#include "model/formats/bvh/bvh_document.h"
#include "model/formats/bvh/bvh_motion.h"
#include "model/formats/flat/flat_files.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/formats/gltf/gltf_motion.h"
#include "model/motion/coordinates.h"
#include "model/motion/inferred_coordinates.h"
#include "model/motion/motion_limits.h"
#include "model/motion/reading_setting.h"
#include "model/motion/recorded_motion.h"
#include "model/motion/sbu.h"
#include "model/retargeting/character.h"

namespace duet::formats {
namespace {

namespace fs = std::filesystem;

using retargeting::Origin;
using retargeting::Setting;

// In the order of Format.
struct FormatNames {
  const char* name;
  const char* title;
};
constexpr FormatNames kFormats[] = {{"sbu", "SBU text"}, {"bvh", "BVH"}, {"gltf", "glTF"},
                                    {"glb", "glTF"},     {"csv", "CSV"}, {"json", "JSON"},
                                    {"npy", "NPY"}};

const char* FormatTitle(Format format) { return kFormats[static_cast<std::size_t>(format)].title; }

bool IsGltf(Format format) { return format == Format::kGltf || format == Format::kGlb; }

gltf::GltfContainer ContainerOf(Format format) {
  return format == Format::kGlb ? gltf::GltfContainer::kBinary : gltf::GltfContainer::kText;
}

// The index of the person in the file.
int PersonOf(const ReadOptions& options) { return options.side == Side::kLeft ? 0 : 1; }

retargeting::CharacterOptions CharacterOptionsOf(const ReadOptions& options) {
  retargeting::CharacterOptions character;
  character.skeleton = options.skeleton;
  character.joint_overrides = options.joint_overrides;
  character.metres_per_unit = options.metres_per_unit;
  if (options.coordinates.has_value()) character.up_axis = options.coordinates->up_axis;
  character.report = options.report;
  return character;
}

constexpr char kBuffer[] = "a buffer";

// The folder of the file that a path leads to; empty if there is no such file.
fs::path FolderOf(const fs::path& path) {
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  return error ? fs::path() : target.parent_path();
}

// Reads the file `name` in the folder of `document`, which names it. Symbolic links are followed
// only to files in the same folder, or in the folder to which `document` itself is a link.
absl::StatusOr<std::string> ReadFileBeside(const fs::path& document, const std::string& name) {
  const fs::path path = document.parent_path() / name;
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  if (error) return base::ReadFile(path, motion::kMaxMotionFileBytes, kBuffer);
  const fs::path here = document.parent_path().empty() ? "." : document.parent_path();
  const fs::path folder = fs::canonical(here, error);
  if (target.parent_path() != folder && target.parent_path() != FolderOf(document)) {
    return absl::InvalidArgumentError(absl::StrCat(path.string(), ": expected ", kBuffer,
                                                   " in the folder of ", document.string(),
                                                   ", got a link to a file in another folder"));
  }
  return base::ReadFile(target, motion::kMaxMotionFileBytes, kBuffer);
}

gltf::GltfFileReader FilesBeside(const fs::path& document) {
  return [document](const std::string& name) { return ReadFileBeside(document, name); };
}

// A file of positions may not state its up axis, which is z for Blender.
void WarnOfUpAxis(const motion::Clip& clip, const ReadOptions& options) {
  if (!options.skeleton.feet) return;
  const std::optional<motion::UpAxis> up = motion::InferUpAxis(options.skeleton, {&clip.poses});
  if (up == motion::UpAxis::kYUp) return;
  options.report->remarks.push_back(absl::StrCat(
      "warning: up axis: as the file was read, the feet are not below the root along y; ",
      up.has_value() ? absl::StrCat(motion::UpAxisName(*up), " would fit; ") : "",
      "specify the up axis"));
}

// Names the reader of other arrays where one does not hold positions of the skeleton's joints.
absl::Status WithResearchHint(const absl::Status& status) {
  if (!absl::StrContains(status.message(), ": shape: ")) return status;
  return absl::Status(
      status.code(),
      absl::StrCat(status.message(),
                   "; read an array of research (HumanML3D, InterGen) with duet_motion.research"));
}

// Reports the coordinates of `file`, whose origins are `unit` and `up_axis`, unless the caller
// states others.
void ReportCoordinates(const motion::Coordinates& file, Origin unit, Origin up_axis,
                       const ReadOptions& options) {
  const bool given = options.coordinates.has_value();
  const motion::Coordinates read = options.coordinates.value_or(file);
  options.report->unit =
      Setting{std::string(LengthUnitName(read.unit)), given ? Origin::kGiven : unit, ""};
  options.report->up_axis =
      Setting{std::string(UpAxisName(read.up_axis)), given ? Origin::kGiven : up_axis, ""};
  const bool named =
      given && motion::StatedMetresPerUnit(std::nullopt, read.unit) == options.metres_per_unit;
  if (!options.metres_per_unit.has_value() || named) return;
  options.report->unit = Setting{absl::StrCat(*options.metres_per_unit, " m"), Origin::kGiven, ""};
}

// The coordinates of a file of positions, which has those of `file` unless the caller states
// others. Positions in a unit of `metres_per_unit` are multiplied by it, which makes them metres.
motion::Coordinates CoordinatesOf(const ReadOptions& options, const motion::Coordinates& file) {
  motion::Coordinates coordinates = options.coordinates.value_or(file);
  if (options.metres_per_unit.has_value()) coordinates.unit = motion::LengthUnit::kMetres;
  return coordinates;
}

float ScaleOf(const ReadOptions& options) {
  return static_cast<float>(options.metres_per_unit.value_or(1));
}

// Reports what a file of positions states. SBU text states nothing.
void Report(const motion::RecordedMotion& motion, const motion::Clip& person,
            const ReadOptions& options) {
  retargeting::ReadingReport* report = options.report;
  report->people = static_cast<int>(motion.people.size());
  report->file_joints = person.joint_names;
  if (person.frame_rate_hz > 0) {
    report->frame_rate = Setting{absl::StrCat(person.frame_rate_hz, " Hz"), Origin::kFile, ""};
  }
  ReportCoordinates(motion.coordinates, motion.says_unit ? Origin::kFile : Origin::kDefault,
                    motion.says_up_axis ? Origin::kFile : Origin::kDefault, options);
}

// SBU text has the skeleton's joints in its order.
void ReportSbu(const flat::SbuOptions& sbu, const ReadOptions& options) {
  retargeting::ReadingReport* report = options.report;
  report->people = 2;
  report->file_joints = sbu.joint_names;
  report->frame_rate = Setting{absl::StrCat(sbu.frame_rate_hz, " Hz"), Origin::kDefault,
                               "as SBU's captures have; K3HI's have 30"};
  ReportCoordinates(sbu.coordinates, Origin::kDefault, Origin::kDefault, options);
  for (const std::string& joint : sbu.joint_names) {
    report->joints.push_back({joint, {{joint, 1}}, Origin::kDefault, ""});
  }
}

// Converts a file of positions to the skeleton's joints in metres, y up.
absl::StatusOr<motion::Clip> ToSkeleton(const motion::RecordedMotion& motion,
                                        const std::string& source, const ReadOptions& options) {
  const bool second = options.side == Side::kRight && motion.people.size() > 1;
  const motion::Clip& person = motion.people[second ? 1 : 0];
  Report(motion, person, options);
  absl::StatusOr<retargeting::JointMap> map =
      retargeting::MapJoints(source, person.joint_names, person.poses, options.skeleton,
                             options.joint_overrides, &options.report->joints);
  if (!map.ok()) return map.status();
  const motion::Coordinates coordinates = CoordinatesOf(options, motion.coordinates);
  motion::Clip clip;
  clip.joint_names = options.skeleton.joint_names;
  clip.frame_rate_hz = person.frame_rate_hz;
  for (int frame = 0; frame < person.frame_count(); ++frame) {
    std::vector<motion::Vec3> pose = ApplyJointMap(*map, person.poses[frame]);
    for (motion::Vec3& position : pose) {
      position = ToWorld(coordinates, position * ScaleOf(options));
    }
    clip.Append(pose);
  }
  const absl::Status body =
      CheckBody(source, options.skeleton, clip.poses, *map, person.joint_names);
  if (!body.ok()) return body;
  if (!options.coordinates.has_value()) WarnOfUpAxis(clip, options);
  return clip;
}

absl::StatusOr<motion::Clip> ReadSbuPerson(const std::string& text, const std::string& source,
                                           const ReadOptions& options) {
  flat::SbuOptions sbu;
  sbu.joint_names = options.skeleton.joint_names;
  sbu.frame_rate_hz = options.frame_rate_hz.value_or(motion::kSbuFrameRateHz);
  // The axis of SBU's unit belongs to that unit.
  const bool own_unit = !options.metres_per_unit.has_value();
  sbu.coordinates = CoordinatesOf(options, own_unit ? sbu.coordinates : motion::Coordinates{});
  ReportSbu(sbu, options);
  absl::StatusOr<flat::SbuRecording> recording = ParseSbu(text, source, sbu);
  if (!recording.ok()) return recording.status();
  motion::Clip person =
      options.side == Side::kLeft ? std::move(recording->left) : std::move(recording->right);
  for (motion::Vec3& position : person.poses.all()) position = position * ScaleOf(options);
  return person;
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
  gltf.animation = options.animation;
  return FromGltf(*document, path.string(), FilesBeside(path), gltf);
}

absl::StatusOr<motion::Clip> ReadNpyPerson(const std::string& content, const std::string& source,
                                           const ReadOptions& options) {
  const absl::StatusOr<motion::RecordedMotion> motion =
      flat::ParseNpy(content, source, options.skeleton.joint_names);
  if (!motion.ok()) return WithResearchHint(motion.status());
  return ToSkeleton(*motion, source, options);
}

absl::StatusOr<motion::Clip> ReadPerson(Format format, const std::string& content,
                                        const fs::path& path, const ReadOptions& options) {
  const std::string source = path.string();
  options.report->format = FormatTitle(format);
  if (options.animation.has_value() && !IsGltf(format)) {
    return absl::InvalidArgumentError(absl::StrCat(source, ": animation: expected none, because ",
                                                   FormatTitle(format), " holds one motion, got ",
                                                   base::Quoted(*options.animation)));
  }
  if (IsGltf(format)) return ReadGltfPerson(content, path, options);
  if (format == Format::kSbuText) return ReadSbuPerson(content, source, options);
  if (format == Format::kBvh) return ReadBvhPerson(content, source, options);
  if (format == Format::kNpy) return ReadNpyPerson(content, source, options);
  absl::StatusOr<motion::RecordedMotion> motion = format == Format::kCsv
                                                      ? flat::ParseCsv(content, source)
                                                      : flat::ParseJsonMotion(content, source);
  if (!motion.ok()) return motion.status();
  return ToSkeleton(*motion, source, options);
}

absl::Status CheckOptions(const ReadOptions& options) {
  if (options.metres_per_unit.has_value()) {
    absl::Status status = retargeting::CheckMetresPerUnit(*options.metres_per_unit);
    if (!status.ok()) return status;
  }
  if (!options.frame_rate_hz.has_value()) return absl::OkStatus();
  return motion::CheckFrameRate("frame rate given", *options.frame_rate_hz);
}

}  // namespace

std::optional<Format> FormatOf(const fs::path& path) {
  const std::string extension = absl::AsciiStrToLower(path.extension().string());
  if (extension == ".txt") return Format::kSbuText;
  if (extension.size() < 2 || extension == ".sbu") return std::nullopt;
  return ParseFormat(extension.substr(1));
}

std::optional<Format> ParseFormat(absl::string_view name) {
  for (std::size_t i = 0; i < std::size(kFormats); ++i) {
    if (name == kFormats[i].name) return static_cast<Format>(i);
  }
  return std::nullopt;
}

bool IsReadable(const fs::path& path) { return FormatOf(path).has_value(); }

std::string HowToConvert(const fs::path& path) {
  static const auto& converters = *new std::map<std::string, const char*>{
      {".fbx", "convert it with duet_fbx.py (contrib/formats)"},
      {".amc", "convert it with duet_asf.py (contrib/formats)"},
      {".asf", "convert its .amc with duet_asf.py (contrib/formats)"},
      {".npz", "read a motion of AMASS or SMPL with duet_motion.research"}};
  const auto found = converters.find(absl::AsciiStrToLower(path.extension().string()));
  return found == converters.end() ? "" : found->second;
}

absl::Status UnknownExtension(const fs::path& path, absl::string_view known) {
  const std::string how = HowToConvert(path);
  return absl::InvalidArgumentError(absl::StrCat(path.string(), ": extension: expected ", known,
                                                 ", got ", base::Quoted(path.extension().string()),
                                                 how.empty() ? "" : "; ", how));
}

absl::StatusOr<motion::Clip> ReadLeader(const fs::path& path, const ReadOptions& options) {
  if (!options.format.has_value() && !IsReadable(path)) {
    return UnknownExtension(path, kReadableExtensions);
  }
  const absl::StatusOr<std::string> content =
      base::ReadFile(path, motion::kMaxMotionFileBytes, "a motion");
  if (!content.ok()) return content.status();
  return ParseLeader(*content, path, options);
}

absl::StatusOr<motion::Clip> ParseLeader(const std::string& content, const fs::path& path,
                                         const ReadOptions& given) {
  retargeting::ReadingReport unread;
  ReadOptions options = given;
  if (options.report == nullptr) options.report = &unread;
  const std::optional<Format> format = options.format.has_value() ? options.format : FormatOf(path);
  if (!format.has_value()) return UnknownExtension(path, kReadableExtensions);
  absl::Status status = CheckOptions(options);
  if (!status.ok()) return status;
  absl::StatusOr<motion::Clip> clip = ReadPerson(*format, content, path, options);
  if (!clip.ok()) return clip.status();
  if (options.frame_rate_hz.has_value()) {
    clip->frame_rate_hz = *options.frame_rate_hz;
    options.report->frame_rate =
        Setting{absl::StrCat(clip->frame_rate_hz, " Hz"), Origin::kGiven, ""};
  }
  if (!(clip->frame_rate_hz > 0)) {
    return MendedBy(absl::InvalidArgumentError(absl::StrCat(
                        path.string(), ": frame rate: expected one, got none in the file")),
                    motion::ReadingSetting::kFrameRate);
  }
  // A position within the limit in the file's unit may exceed it in metres.
  status = CheckClip(path.string(), *clip);
  if (!status.ok()) return status;
  return clip;
}

absl::StatusOr<std::vector<motion::Vec3>> ReadFollowerStart(const fs::path& path,
                                                            const ReadOptions& options) {
  ReadOptions any_rate = options;
  // A single pose needs no frame rate.
  if (!any_rate.frame_rate_hz.has_value()) any_rate.frame_rate_hz = motion::kSbuFrameRateHz;
  absl::StatusOr<motion::Clip> clip = ReadLeader(path, any_rate);
  if (!clip.ok()) return clip.status();
  const absl::Span<const motion::Vec3> start = clip->poses[0];
  return std::vector<motion::Vec3>(start.begin(), start.end());
}

absl::StatusOr<std::vector<fs::path>> WritePair(const fs::path& path, const motion::ClipPair& pair,
                                                const motion::Skeleton& skeleton,
                                                const WriteOptions& options) {
  const std::optional<Format> format = FormatOf(path);
  if (!format.has_value()) return UnknownExtension(path, kWritableExtensions);
  return WritePeople(path, *format, {pair.leader, pair.follower}, skeleton, options);
}

absl::StatusOr<std::string> FormatPeople(Format format, const std::vector<motion::Clip>& people,
                                         const motion::Skeleton& skeleton,
                                         const WriteOptions& options) {
  absl::Status status = CheckPeople(people, skeleton);
  if (!status.ok()) return status;
  switch (format) {
    case Format::kGltf:
    case Format::kGlb:
      return gltf::FormatGltf(people, skeleton, options.provenance, ContainerOf(format));
    case Format::kCsv:
      return flat::FormatCsv(people);
    case Format::kNpy:
      return flat::FormatNpy(people);
    case Format::kJson:
      return flat::FormatJsonMotion(people, skeleton,
                                    people.size() > 1 ? options.follower_rotations : nullptr);
    case Format::kBvh:
      if (people.size() == 1) {
        return FormatBvh(bvh::ToBvh(people[0], skeleton, options.bvh_metres_per_unit));
      }
      return absl::InvalidArgumentError(
          "people: expected 1, got 2; BVH has a file for each person");
    case Format::kSbuText:
      break;
  }
  if (people.size() != 2) {
    return absl::InvalidArgumentError("people: expected 2, got 1; SBU text always has two");
  }
  flat::SbuOptions sbu;
  sbu.joint_names = skeleton.joint_names;
  return flat::FormatSbu({people[0], people[1]}, sbu);
}

absl::StatusOr<std::vector<fs::path>> WritePeople(const fs::path& path, Format format,
                                                  const std::vector<motion::Clip>& people,
                                                  const motion::Skeleton& skeleton,
                                                  const WriteOptions& options) {
  std::vector<fs::path> files = {path};
  std::vector<std::vector<motion::Clip>> contents = {people};
  if (format == Format::kBvh && people.size() == 2) {
    absl::Status status = CheckPeople(people, skeleton);
    if (!status.ok()) return status;
    files = {fs::path(path).replace_extension(".leader.bvh"),
             fs::path(path).replace_extension(".follower.bvh")};
    contents = {{people[0]}, {people[1]}};
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    const absl::StatusOr<std::string> content =
        FormatPeople(format, contents[i], skeleton, options);
    if (!content.ok()) return content.status();
    absl::Status status = base::WriteFile(files[i], *content);
    if (!status.ok()) return status;
  }
  return files;
}

absl::Status CheckReadable(const std::filesystem::path& path, const std::optional<Format>& format) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return base::MissingFile(path);
  }
  if (std::filesystem::is_directory(path, error)) {
    return absl::InvalidArgumentError(
        absl::StrCat(path.string(), ": expected a motion file, got a folder"));
  }
  if (format.has_value() || IsReadable(path)) return absl::OkStatus();
  if (!HowToConvert(path).empty()) return UnknownExtension(path, kReadableExtensions);
  return MendedBy(UnknownExtension(path, kReadableExtensions), motion::ReadingSetting::kFormat);
}

absl::Status CheckFolderOf(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (std::filesystem::is_directory(folder, error)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(path.string(), ": there is no folder ", folder.string()));
}

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
  const absl::StatusOr<std::string> content =
      base::ReadFile(rig.file, motion::kMaxMotionFileBytes, "a rig");
  if (!content.ok()) return content.status();
  retargeting::CharacterOptions options = CharacterOptionsOf(rig.reading);
  // The feet of a rig may lack toes.
  options.missing_toes = retargeting::MissingToes::kAtTheFeet;
  const int person = PersonOf(rig.reading);
  if (IsGltf(format)) {
    return gltf::OntoGltfRig(follower, *content, source, FilesBeside(rig.file),
                             {options, person, std::nullopt}, ContainerOf(format));
  }
  const absl::StatusOr<bvh::BvhDocument> document = bvh::ParseBvh(*content, source);
  if (!document.ok()) return document.status();
  const absl::StatusOr<bvh::BvhDocument> written =
      OntoBvhRig(follower, *document, source, {options, person});
  if (!written.ok()) return written.status();
  return FormatBvh(*written);
}

}  // namespace duet::formats
