#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_CHARACTER_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_CHARACTER_H_

#include <string>
#include <vector>

#include "model/formats/gltf/gltf_export.h"
#include "model/motion/provenance.h"
#include "model/retargeting/character_rig.h"

namespace duet::formats::gltf {

// Formats a rig from another format as glTF: its names, hierarchy and bone lengths, in metres, y
// up, with a slender skinned body (retargeting::MakeStickFigure) and one animation. The scene's
// extras hold `provenance`, which may be null.
//
// Requires a rig whose joints are not rotated at rest.
// Shapes: poses [frames >= 1], with the rig's joints.
std::string FormatCharacter(const retargeting::CharacterRig& rig,
                            const std::vector<retargeting::CharacterPose>& poses,
                            double frame_rate_hz, const motion::Provenance* provenance,
                            GltfContainer container);

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_CHARACTER_H_
