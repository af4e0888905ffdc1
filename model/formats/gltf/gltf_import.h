#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_IMPORT_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_IMPORT_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/gltf/gltf_buffers.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/motion/clip.h"
#include "model/retargeting/character.h"

namespace duet::formats::gltf {

struct GltfImportOptions : retargeting::CharacterOptions {
  // The index of the character, in a file with several. Skins that share joints are one character.
  // Without skins, each tree of animated nodes is one.
  int person = 0;
  // If absent, the rate of the keys, or 30 Hz if they are farther apart than at 15 Hz.
  std::optional<double> frame_rate_hz;
  // Receives the nodes of the character's joints, in the order of its tree; may be null. If it is
  // set, only the rig is needed, and a character without an animation is accepted in its rest pose.
  std::vector<int>* nodes = nullptr;
  // The animation to use, by its name, or by the part of it that follows "|". If absent, the first
  // in which the character moves; poses that are held do not count.
  std::optional<std::string> animation = std::nullopt;
  // Receives the document with the character in the pose of `posed_frame` of the clip; may be null.
  GltfDocument* posed = nullptr;
  int posed_frame = 0;
};

// Converts an animated skeleton to the skeleton's joint positions by forward kinematics. Samples
// an animation at a constant rate from its first key to its last.
//
// Errors: INVALID_ARGUMENT naming `source` if there is no skeleton or no animation of it (of the
//         name in `options`; the message lists those of the file), for
//         invalid values and too many frames; those of retargeting::ToClip.
absl::StatusOr<motion::Clip> FromGltf(const GltfDocument& document, absl::string_view source,
                                      const GltfFileReader& read_file,
                                      const GltfImportOptions& options = {});

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_IMPORT_H_
