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

// A clip of motion::SbuSkeleton's joints on a character of a glTF file: all of the file stays
// (nodes, rest pose, skins, meshes, materials) but its animations and their data, in whose place
// one moves the character (retargeting::TransferToRig). Buffers of files beside it are taken in;
// pictures beside it are not.
//
// `content` is the file, .gltf or .glb; `options` say how it is read and which character is taken.
// Errors: INVALID_ARGUMENT naming `source` for a file that FromGltf does not read or a rig that
//         TransferToRig refuses; what `read_file` says.
absl::StatusOr<std::string> OntoGltfRig(const motion::Clip& clip, absl::string_view content,
                                        absl::string_view source, const GltfFileReader& read_file,
                                        const GltfImportOptions& options, GltfContainer container);

// The rig of a character of a glTF file, for writing in another format. Errors as of OntoGltfRig.
absl::StatusOr<retargeting::CharacterRig> ReadGltfRig(absl::string_view content,
                                                      absl::string_view source,
                                                      const GltfFileReader& read_file,
                                                      const GltfImportOptions& options);

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_RIG_H_
