#ifndef DUET_MODEL_FORMATS_RESEARCH_SMPL_MOTION_H_
#define DUET_MODEL_FORMATS_RESEARCH_SMPL_MOTION_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "model/formats/research/npz_archive.h"
#include "model/motion/clip.h"
#include "model/retargeting/character.h"

namespace duet::formats::research {

// Reads a motion of a body model of the SMPL family and poses the model's joints by forward
// kinematics. `motion` has these arrays, in metres and radians (axis times angle):
//
//   poses [frames, >= 66] or [frames, joints, 3] (AMASS, SMPL); or root_orient [frames, 3] and
//   pose_body [frames, 63] or [frames, 21, 3] (AMASS, Inter-X), also called global_orient and
//   body_pose
//   trans or transl [frames, 3]; without them the person stays at the origin
//   betas [shapes] or [1 or more, shapes], of which the first row is used; without them the shape
//   is the model's mean mocap_framerate, mocap_frame_rate or fps; without them the returned rate is
//   0
//
// Hands and face are not used. The up axis is inferred as in all formats with a hierarchy: AMASS
// has z up.
//
// Errors: INVALID_ARGUMENT naming the file, the array, the expected value and the actual one; those
//         of RestJoints and retargeting::ToClip.
absl::StatusOr<motion::Clip> FromSmpl(const NpzArchive& motion, const NpzArchive& model,
                                      const retargeting::CharacterOptions& options);

// Whether a file may be a motion that FromSmpl reads: its directory names poses. Other .npz files,
// body models among them, are not motions. False if the file cannot be read.
bool MayBeSmplMotion(const std::filesystem::path& file);

}  // namespace duet::formats::research

#endif  // DUET_MODEL_FORMATS_RESEARCH_SMPL_MOTION_H_
