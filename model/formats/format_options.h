#ifndef DUET_MODEL_FORMATS_FORMAT_OPTIONS_H_
#define DUET_MODEL_FORMATS_FORMAT_OPTIONS_H_

#include "model/formats/motion_file.h"
#include "model/retargeting/character.h"

// Converts options of all formats to those of single formats. Internal to this folder.

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
  character.notes = options.notes;
  character.report = options.report;
  return character;
}

}  // namespace duet::formats

#endif  // DUET_MODEL_FORMATS_FORMAT_OPTIONS_H_
