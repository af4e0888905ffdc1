#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_RIG_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_RIG_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/gltf/gltf_buffers.h"
#include "model/formats/gltf/gltf_export.h"
#include "model/formats/gltf/gltf_import.h"
#include "model/motion/clip.h"
#include "model/retargeting/character_rig.h"

namespace duet::formats::gltf {

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

// Returns the rig of a character of a glTF file, to write in another format. Errors: those of
// OntoGltfRig.
absl::StatusOr<retargeting::CharacterRig> ReadGltfRig(absl::string_view content,
                                                      absl::string_view source,
                                                      const GltfFileReader& read_file,
                                                      const GltfImportOptions& options);

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_RIG_H_
