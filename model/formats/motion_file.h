#ifndef DUET_MODEL_FORMATS_MOTION_FILE_H_
#define DUET_MODEL_FORMATS_MOTION_FILE_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/coordinates.h"
#include "model/motion/provenance.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_mapping.h"
#include "model/retargeting/reading_report.h"

// The front door of motion files: the extension decides the format (docs/formats.md).
//
//   .txt    SBU text, two people
//   .bvh    joint angles, one person a ROOT
//   .gltf, .glb  an animated skeleton a person
//   .amc    joint angles, with the skeleton in an .asf file beside it
//   .csv    positions by column, one or two people
//   .json   positions, one or two people
//   .npy    positions as an array, [frames, joints, 3] or [2, frames, joints, 3]
//   .usda   an animated skeleton a person; written, not read

namespace duet::formats {

// Which person of a file with two. SBU text: their place in the image. Every other format: left is
// the first person (the leader of a pair), right the second.
enum class Side { kLeft, kRight };

// kGlb is binary glTF; reading tells the two apart by their first bytes.
enum class Format { kSbuText, kBvh, kGltf, kGlb, kAmc, kCsv, kJson, kNpy, kUsda };

struct ReadOptions {
  // Replaces what the file's extension says.
  std::optional<Format> format;
  Side side = Side::kLeft;
  // The joints wanted, in their order.
  motion::Skeleton skeleton = motion::SbuSkeleton();
  // Replaces the file's frame rate. Required for .npy; SBU text without it counts as 15.
  std::optional<double> frame_rate_hz;
  // Replaces what the file says or its format implies: SBU text the data set's normalised unit;
  // CSV and JSON what they state, else metres, y up; NPY metres, y up.
  std::optional<motion::Coordinates> coordinates;
  // BVH, glTF, ASF: metres in one unit of the file (0.01 for centimetres). Found from the height
  // when absent.
  std::optional<double> metres_per_unit;
  retargeting::JointOverrides joint_overrides;
  // Receives what was decided (unit, up axis, torso joint), for people to read. May be null.
  std::vector<std::string>* notes = nullptr;
  // The same with all its details, also where reading fails half way. May be null.
  retargeting::ReadingReport* report = nullptr;
};

// Reads one person's motion.
//
// Shapes: [frames >= 1, options.skeleton]. Units: world metres, y up.
// Errors: NOT_FOUND, PERMISSION_DENIED; INVALID_ARGUMENT naming the file, the place in it, what
//         came and what was wanted.
absl::StatusOr<motion::Clip> ReadLeader(const std::filesystem::path& path,
                                        const ReadOptions& options = {});

// The same of a motion that is no file, such as a pipe's: `content` is all of it, `name` what
// errors call it. Wants options.format, and a motion that needs no file beside it.
absl::StatusOr<motion::Clip> ParseLeader(const std::string& content, const std::string& name,
                                         const ReadOptions& options);

// The first frame of any file that ReadLeader reads: where a follower starts. [skeleton joints]
absl::StatusOr<std::vector<motion::Vec3>> ReadFollowerStart(const std::filesystem::path& path,
                                                            const ReadOptions& options = {});

inline constexpr double kCentimetre = 0.01;

struct WriteOptions {
  // Who made the follower: .glb, .gltf and .usda have a place for it. May be null.
  const motion::Provenance* provenance = nullptr;
  // BVH says no unit. Animation tools take it for centimetres, Blender for its own unit, a metre.
  double bvh_metres_per_unit = kCentimetre;
  // BVH has angles, near gimbal lock unlike what turns between frames: more keys say more
  // (bvh::BvhKeys), 1 to kMostBvhKeysPerFrame.
  int bvh_keys_per_frame = 1;
  // Receives what is worth telling of what was written. May be null.
  std::vector<std::string>* notes = nullptr;
};
inline constexpr int kMostBvhKeysPerFrame = 16;

// Writes a pair: .glb, .gltf, .usda, .csv, .npy, .json and .txt (in SBU's own unit) as one file;
// .bvh as <stem>.leader.bvh and <stem>.follower.bvh in one shared world. Returns the files written.
//
// Errors: INVALID_ARGUMENT for an unknown extension, joints other than the skeleton's, people of
//         different length, positions that are not finite; PERMISSION_DENIED.
absl::StatusOr<std::vector<std::filesystem::path>> WritePair(const std::filesystem::path& path,
                                                             const motion::ClipPair& pair,
                                                             const motion::Skeleton& skeleton,
                                                             const WriteOptions& options = {});

// The same for a person alone (one file, .bvh as well), or a leader and a follower, in a format
// that need not be the extension's.
absl::StatusOr<std::vector<std::filesystem::path>> WritePeople(
    const std::filesystem::path& path, Format format, const std::vector<motion::Clip>& people,
    const motion::Skeleton& skeleton, const WriteOptions& options = {});
// What WritePeople writes where it writes one file: .bvh holds one person, SBU text two.
absl::StatusOr<std::string> FormatPeople(Format format, const std::vector<motion::Clip>& people,
                                         const motion::Skeleton& skeleton,
                                         const WriteOptions& options = {});

// The format that an extension stands for; absent for an unknown one.
std::optional<Format> FormatOf(const std::filesystem::path& path);
// By name: "bvh", "gltf", "glb", "usda", "amc", "csv", "json", "npy" or "sbu".
std::optional<Format> ParseFormat(absl::string_view name);
// The names of those that are read.
inline constexpr char kReadableFormatNames[] = "amc, bvh, csv, glb, gltf, json, npy or sbu";
bool IsWritable(Format format);
bool IsReadable(Format format);

// Whether WritePair, ReadLeader know the extension; the file need not exist.
bool IsWritable(const std::filesystem::path& path);
bool IsReadable(const std::filesystem::path& path);
// Which those are, for UnknownExtension and for callers that know more.
inline constexpr char kWritableExtensions[] =
    ".glb, .gltf, .usda, .bvh, .csv, .npy, .json or .txt (SBU text)";
inline constexpr char kReadableExtensions[] =
    ".txt (SBU text), .bvh, .gltf, .glb, .amc (beside its .asf), .csv, .npy or .json";
// INVALID_ARGUMENT "path: extension: came ..., wanted <known>".
absl::Status UnknownExtension(const std::filesystem::path& path, absl::string_view known);

}  // namespace duet::formats

#endif  // DUET_MODEL_FORMATS_MOTION_FILE_H_
