#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_CHARACTER_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_CHARACTER_H_

#include <string>
#include <vector>

#include "model/formats/gltf/gltf_export.h"
#include "model/motion/provenance.h"
#include "model/retargeting/character_rig.h"

namespace duet::formats::gltf {

// A rig of another format's file as glTF: its names, hierarchy and bone lengths, in metres, y up,
// with a slender skinned body (retargeting::MakeStickFigure) and one animation. What `provenance`
// says is in the scene's extras; it may be null.
//
// Requires a rig whose joints are not turned at rest. Shapes: poses [frames >= 1], of its joints.
std::string FormatCharacter(const retargeting::CharacterRig& rig,
                            const std::vector<retargeting::CharacterPose>& poses,
                            double frame_rate_hz, const motion::Provenance* provenance,
                            GltfContainer container);

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_CHARACTER_H_
