#ifndef DUET_MODEL_FORMATS_FBX_FBX_RIG_H_
#define DUET_MODEL_FORMATS_FBX_FBX_RIG_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/fbx/fbx_import.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/formats/gltf/gltf_rig.h"
#include "model/motion/clip.h"
#include "model/retargeting/character_rig.h"

namespace duet::formats::fbx {

// Returns the rig of a character of an FBX file, which need not be animated. Bones of a skin are at
// rest where the skin was bound to them; the pose of the file is the rest pose of the others.
// Errors: those of ConvertFbx and gltf::ReadGltfRig.
absl::StatusOr<retargeting::CharacterRig> ReadFbxRig(absl::string_view content,
                                                     absl::string_view source,
                                                     const FbxImportOptions& options);

// Writes a clip onto the rig of an FBX file, as glTF in metres, y up: its nodes, skins and meshes
// with their diffuse colours, without textures.
// Errors: those of ConvertFbx and gltf::OntoGltfRig.
absl::StatusOr<std::string> OntoFbxRig(const motion::Clip& clip, absl::string_view content,
                                       absl::string_view source, const FbxImportOptions& options,
                                       gltf::GltfContainer container);

}  // namespace duet::formats::fbx

#endif  // DUET_MODEL_FORMATS_FBX_FBX_RIG_H_
