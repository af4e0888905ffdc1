#ifndef DUET_MODEL_FORMATS_FBX_FBX_IMPORT_H_
#define DUET_MODEL_FORMATS_FBX_FBX_IMPORT_H_

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/fbx/fbx_program.h"
#include "model/formats/gltf/gltf_buffers.h"
#include "model/formats/gltf/gltf_import.h"
#include "model/motion/clip.h"
#include "model/retargeting/character.h"

namespace duet::formats::fbx {

struct FbxImportOptions : retargeting::CharacterOptions {
  int person = 0;                        // the index of the character in the file
  std::optional<double> frame_rate_hz;   // if absent, the file's
  std::optional<std::string> animation;  // a take, as GltfImportOptions::animation
};

// Converts an animated skeleton to the skeleton's joint positions by forward kinematics. Unit, up
// axis and rate are those that the file states, unless the options specify others. A unit with
// which legs would not have a person's length is ignored, with a warning.
//
// Errors: those of ConvertFbx and gltf::FromGltf.
absl::StatusOr<motion::Clip> FromFbx(absl::string_view content, absl::string_view source,
                                     const FbxImportOptions& options = {});

// How the scene of a file is read. FromFbx and the rig use it.
gltf::GltfImportOptions GltfOptionsOf(const FbxScene& scene, const FbxImportOptions& options);

// A scene has no files beside it. Returns NOT_FOUND.
absl::StatusOr<std::string> NoFileBeside(const std::string& name);

}  // namespace duet::formats::fbx

#endif  // DUET_MODEL_FORMATS_FBX_FBX_IMPORT_H_
