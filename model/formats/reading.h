#ifndef DUET_MODEL_FORMATS_READING_H_
#define DUET_MODEL_FORMATS_READING_H_

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"
#include "model/formats/motion_file.h"
#include "model/retargeting/character.h"

// What the readers of motions and of rigs have in common. Internal to this folder.

namespace duet::formats {

inline bool IsGltf(Format format) { return format == Format::kGltf || format == Format::kGlb; }

// The index of the person in the file.
inline int PersonOf(const ReadOptions& options) { return options.side == Side::kLeft ? 0 : 1; }

inline retargeting::CharacterOptions CharacterOptionsOf(const ReadOptions& options) {
  retargeting::CharacterOptions character;
  character.skeleton = options.skeleton;
  character.joint_overrides = options.joint_overrides;
  character.metres_per_unit = options.metres_per_unit;
  if (options.coordinates.has_value()) character.up_axis = options.coordinates->up_axis;
  character.report = options.report;
  return character;
}

// Reads the file `name` in the folder of `document`, which names it. `what` names the kind of file,
// with its article. Symbolic links are followed only to files in the same folder, or in the folder
// to which `document` itself is a link.
//
// Errors: those of base::ReadFile; INVALID_ARGUMENT for a link to another folder.
absl::StatusOr<std::string> ReadFileBeside(const std::filesystem::path& document,
                                           const std::string& name, const char* what);

}  // namespace duet::formats

#endif  // DUET_MODEL_FORMATS_READING_H_
