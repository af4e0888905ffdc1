#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_IMPORT_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_IMPORT_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/gltf/gltf_buffers.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/motion/clip.h"
#include "model/retargeting/character.h"

namespace duet::formats::gltf {

struct GltfImportOptions : retargeting::CharacterOptions {
  // Which character, in a file with several: skins that share joints are one. Where there are no
  // skins, each tree of animated nodes is one.
  int person = 0;
  // Absent: as close as the keys are, 30 where they are farther apart than at 15.
  std::optional<double> frame_rate_hz;
  // Receives the nodes that the character's joints are, in the order of its tree; may be null. Who
  // asks for them is after the rig: a character that nothing moves will do, and stands at rest.
  std::vector<int>* nodes = nullptr;
};

// An animated skeleton through forward kinematics to the skeleton's joint positions: the first
// animation that moves the character, sampled at an even rate from its first key to its last.
//
// Errors: INVALID_ARGUMENT naming `source`: no skeleton, nothing that moves it, values out of
//         place, more frames than a motion may have, and what retargeting::ToClip refuses.
absl::StatusOr<motion::Clip> FromGltf(const GltfDocument& document, absl::string_view source,
                                      const GltfFileReader& read_file,
                                      const GltfImportOptions& options = {});

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_IMPORT_H_
