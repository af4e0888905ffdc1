#ifndef DUET_MODEL_FORMATS_FBX_FBX_PROGRAM_H_
#define DUET_MODEL_FORMATS_FBX_FBX_PROGRAM_H_

#include <filesystem>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/motion/coordinates.h"

namespace duet::formats::fbx {

// An FBX file as glTF, in the file's own unit and axes, and what the file states.
struct FbxScene {
  std::string glb;  // an animation for each take, sampled at the file's rate
  // Absent if the file states no value, or one that Duet does not support.
  std::optional<double> unit_scale_factor;  // centimetres in one unit
  std::optional<motion::UpAxis> up_axis;
  std::optional<double> frame_rate_hz;
};

// Adds the skinned meshes, and converts to metres, y up.
struct FbxMeshes {
  double metres_per_unit = 1;
  motion::UpAxis up_axis = motion::UpAxis::kYUp;
};

// The program duet-fbx: the file that the environment variable DUET_FBX_PROGRAM names, otherwise
// the one in the folder of the running program, or the first one in PATH (the running program may
// be Python). It need not exist.
std::filesystem::path FbxProgram();

// Converts a file with the program duet-fbx, in a process of its own with bounded time and memory.
// `source` names the file in messages.
//
// Errors: FAILED_PRECONDITION without the program; INVALID_ARGUMENT naming `source` for a file that
//         is not FBX, that assimp rejects, or on which it fails or exceeds a limit.
absl::StatusOr<FbxScene> ConvertFbx(absl::string_view content, absl::string_view source,
                                    const std::optional<FbxMeshes>& meshes = std::nullopt);

}  // namespace duet::formats::fbx

#endif  // DUET_MODEL_FORMATS_FBX_FBX_PROGRAM_H_
