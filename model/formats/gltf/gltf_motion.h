#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_MOTION_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_MOTION_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/motion/clip.h"
#include "model/motion/provenance.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/character.h"

// Converts between the motions of people and glTF documents: reading (gltf_import.cc), writing
// (gltf_export.cc), and writing onto a character of a file (gltf_rig.cc).

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

enum class GltfContainer {
  kBinary,  // .glb
  kText     // .gltf, with its buffer as base64 inside
};

// Writes one person, or a leader and a follower, as skinned mannequins. Each has a skeleton; all
// share one animation. Units are metres, y up, in the clips' world. The rest pose is the T pose of
// MakeRig with the feet on the floor at the origin. Joints are nodes with the skeleton's names.
// Every joint is exactly at its position in the clip: bones rotate, and those whose length changes
// are also translated. The scene's extras hold `provenance`, which may be null. Requires people
// whom CheckPeople accepts.
std::string FormatGltf(const std::vector<motion::Clip>& people, const motion::Skeleton& skeleton,
                       const motion::Provenance* provenance, GltfContainer container);

// Writes a clip of the joints of `options.skeleton` onto a character of a glTF file. The nodes,
// rest pose, skins, meshes and materials of the file are kept. One new animation of the character
// (retargeting::TransferToRig) replaces its animations; their data stay unused. Buffers in other
// files are embedded; images in other files are not.
//
// `content` is the file, .gltf or .glb; `options` select the character and how to read it.
// Errors: INVALID_ARGUMENT naming `source` for a file that FromGltf rejects or a rig that
//         TransferToRig rejects; those of `read_file`.
absl::StatusOr<std::string> OntoGltfRig(const motion::Clip& clip, absl::string_view content,
                                        absl::string_view source, const GltfFileReader& read_file,
                                        const GltfImportOptions& options, GltfContainer container);

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_MOTION_H_
