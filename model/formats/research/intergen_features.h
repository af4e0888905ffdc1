#ifndef DUET_MODEL_FORMATS_RESEARCH_INTERGEN_FEATURES_H_
#define DUET_MODEL_FORMATS_RESEARCH_INTERGEN_FEATURES_H_

#include <vector>

#include "model/formats/research/placement.h"

// InterGen's 262 numbers for each frame t of a person with the joints of BodySkeleton():
//
//     0 -  65  positions of joints 0 to 21, metres, y up
//    66 - 131  the way of joints 0 to 21 from t to t + 1
//   132 - 257  rotations of joints 1 to 21 relative to their parents, each as six numbers: the rows
//              of the first two columns of its matrix (R00 R01 R10 R11 R20 R21)
//   258 - 261  1 if left ankle, left ball, right ankle, right ball of the foot stay on the floor
//              (the square of their way is less than 0.001; ankles below 0.12 m, balls below 0.05)
//
// Everybody's lowest joint is put on the floor. The first person starts at x = z = 0 and faces z
// (across the hips); the second keeps its place and heading relative to the first. The last frame
// is dropped.
//
// Source: Liang et al. 2024, "InterGen: diffusion-based multi-human motion generation under complex
// interactions", and process_motion_np and swap_left_right_rot of github.com/tr3e/InterGen, written
// anew from its definition. InterGen copies the rotations from the fit of a body model. Positions
// do not hold them: here they are those of a person whose rest pose is a T pose, with the least
// rotation from parent to child that the bones allow.

namespace duet::formats::research {

inline constexpr int kInterGenWidth = 262;

// One or two people, placed as above, with all frames.
std::vector<std::vector<BodyPose>> AtInterGenStart(
    const std::vector<std::vector<BodyPose>>& people);

// Shapes: [frames - 1, 262], row-major. Requires a person of AtInterGenStart and at least two
// frames.
std::vector<float> InterGenFeatures(const std::vector<BodyPose>& placed);

}  // namespace duet::formats::research

#endif  // DUET_MODEL_FORMATS_RESEARCH_INTERGEN_FEATURES_H_
