#ifndef DUET_MODEL_FORMATS_MOTION_FILE_H_
#define DUET_MODEL_FORMATS_MOTION_FILE_H_

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/coordinates.h"
#include "model/motion/joint_rotations.h"
#include "model/motion/provenance.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"
#include "model/retargeting/reading_report.h"

// Reads and writes motion files. The extension selects the format (docs/formats.md).
//
//   .txt    SBU text, two people
//   .bvh    joint angles, one person per ROOT
//   .gltf, .glb  an animated skeleton per person
//   .csv    positions by column, one or two people
//   .json   positions, one or two people
//   .npy    positions as an array, [frames, joints, 3] or [2, frames, joints, 3]
//
// Scripts of contrib/formats convert FBX and ASF/AMC; duet_motion.research reads and writes
// the arrays of research.

namespace duet::formats {

// Selects a person of a file with two. In SBU text, it is the place in the image. In every other
// format, left is the first person (the leader of a pair) and right is the second.
enum class Side { kLeft, kRight };

// kGlb is binary glTF. A reader distinguishes the two by their first bytes.
enum class Format { kSbuText, kBvh, kGltf, kGlb, kCsv, kJson, kNpy };

struct ReadOptions {
  // Overrides the file's extension.
  std::optional<Format> format;
  Side side = Side::kLeft;
  // The joints to return, in their order.
  motion::Skeleton skeleton = motion::SbuSkeleton();
  // Overrides the file's frame rate. Required for .npy; the default for SBU text is 15 Hz.
  std::optional<double> frame_rate_hz;
  // Overrides the file's coordinates. Defaults: SBU text has the data set's normalised unit; CSV
  // and JSON have what they state, or metres, y up; NPY has metres, y up.
  std::optional<motion::Coordinates> coordinates;
  // Metres in one unit of the file (0.01 for centimetres); overrides the unit of `coordinates`. If
  // absent, BVH and glTF have an inferred one (model/motion/inferred_coordinates.h).
  std::optional<double> metres_per_unit;
  // glTF: the name of the animation. If absent, the first in which the person moves. Other formats
  // hold one motion and reject a name.
  std::optional<std::string> animation;
  retargeting::JointOverrides joint_overrides;
  // Receives the decisions (unit, up axis, torso joint), also if reading fails. May be null.
  retargeting::ReadingReport* report = nullptr;
};

// Reads one person's motion.
//
// Shapes: [frames >= 1, options.skeleton]. Units: world metres, y up.
// Errors: NOT_FOUND, PERMISSION_DENIED; INVALID_ARGUMENT naming the file, the place in it, the
//         expected value and the actual one.
absl::StatusOr<motion::Clip> ReadLeader(const std::filesystem::path& path,
                                        const ReadOptions& options = {});

// The same for the content of the file `path`, which need not exist.
absl::StatusOr<motion::Clip> ParseLeader(const std::string& content,
                                         const std::filesystem::path& path,
                                         const ReadOptions& options);

// The first frame of any file that ReadLeader reads, as a follower's start. [skeleton joints]
absl::StatusOr<std::vector<motion::Vec3>> ReadFollowerStart(const std::filesystem::path& path,
                                                            const ReadOptions& options = {});

inline constexpr double kCentimetre = 0.01;

struct WriteOptions {
  // The origin of the follower, which .glb and .gltf store. May be null.
  const motion::Provenance* provenance = nullptr;
  // BVH does not state its unit. Animation tools assume centimetres, Blender its own unit, a metre.
  double bvh_metres_per_unit = kCentimetre;
  // Joint rotations of the follower, which .json stores beside a pair. May be null.
  const motion::JointRotations* follower_rotations = nullptr;
};

// Writes a pair: .glb, .gltf, .csv, .npy, .json and .txt (in SBU's own unit) as one file; .bvh as
// <stem>.leader.bvh and <stem>.follower.bvh in one shared world. Returns the written files.
//
// Errors: INVALID_ARGUMENT for an unknown extension, joints other than the skeleton's, people with
//         different numbers of frames, positions that are not finite; PERMISSION_DENIED.
absl::StatusOr<std::vector<std::filesystem::path>> WritePair(const std::filesystem::path& path,
                                                             const motion::ClipPair& pair,
                                                             const motion::Skeleton& skeleton,
                                                             const WriteOptions& options = {});

// Writes one person (one file in every format), or a leader and a follower, in a format that may
// differ from the extension's.
absl::StatusOr<std::vector<std::filesystem::path>> WritePeople(
    const std::filesystem::path& path, Format format, const std::vector<motion::Clip>& people,
    const motion::Skeleton& skeleton, const WriteOptions& options = {});
// The content that WritePeople writes to a single file. .bvh holds one person, SBU text two.
absl::StatusOr<std::string> FormatPeople(Format format, const std::vector<motion::Clip>& people,
                                         const motion::Skeleton& skeleton,
                                         const WriteOptions& options = {});

// The format of an extension; absent if the extension is unknown.
std::optional<Format> FormatOf(const std::filesystem::path& path);
// Parses a name: "bvh", "gltf", "glb", "csv", "json", "npy" or "sbu".
std::optional<Format> ParseFormat(absl::string_view name);
// The names of the formats.
inline constexpr char kReadableFormatNames[] = "bvh, csv, glb, gltf, json, npy or sbu";

// Whether the extension is one of a format; the file need not exist.
bool IsReadable(const std::filesystem::path& path);
// The extensions, for UnknownExtension and for callers with further formats.
inline constexpr char kWritableExtensions[] =
    ".glb, .gltf, .bvh, .csv, .npy, .json or .txt (SBU text)";
inline constexpr char kReadableExtensions[] =
    ".txt (SBU text), .bvh, .gltf, .glb, .csv, .npy or .json";
// What converts a file of another format: "convert it with duet_fbx.py (contrib/formats)". Empty if
// nothing does.
std::string HowToConvert(const std::filesystem::path& path);
// INVALID_ARGUMENT "path: extension: expected <known>, got ...", with HowToConvert.
absl::Status UnknownExtension(const std::filesystem::path& path, absl::string_view known);

// Checks, before any work is done, that a file exists and has a format that is read: `format`, or
// that of its extension. Errors: NOT_FOUND, INVALID_ARGUMENT.
absl::Status CheckReadable(const std::filesystem::path& path, const std::optional<Format>& format);

// INVALID_ARGUMENT unless the folder that a file is to be written to exists.
absl::Status CheckFolderOf(const std::filesystem::path& path);

// A BVH or glTF whose rig the follower is written onto, and the options to read it.
struct FollowerRig {
  std::filesystem::path file;
  ReadOptions reading;
};

// The formats that have a rig.
inline constexpr char kRigExtensions[] = "a .bvh, .glb or .gltf";
bool HasRig(Format format);

// Whether a follower on a rig of the format `rig` can be written in the format `written`: a BVH as
// a BVH, a .glb or .gltf as either of the two.
bool FitsRig(Format written, Format rig);

// Formats the follower on the rig: everything in the rig's file except the motion is kept
// (bvh::OntoBvhRig, gltf::OntoGltfRig). Reports to rig.reading.report, like every reader.
//
// Errors: those of reading the rig; INVALID_ARGUMENT for an unsuitable rig, or a format that
//         FitsRig does not accept.
absl::StatusOr<std::string> FormatOntoRig(const motion::Clip& follower, const FollowerRig& rig,
                                          Format format);

}  // namespace duet::formats

#endif  // DUET_MODEL_FORMATS_MOTION_FILE_H_
