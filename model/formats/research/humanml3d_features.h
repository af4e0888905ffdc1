#ifndef DUET_MODEL_FORMATS_RESEARCH_HUMANML3D_FEATURES_H_
#define DUET_MODEL_FORMATS_RESEARCH_HUMANML3D_FEATURES_H_

#include <vector>

#include "absl/types/span.h"
#include "model/formats/research/placement.h"

// HumanML3D's 263 numbers for each frame t of one person with the joints of BodySkeleton(), whose
// lowest joint is put on the floor, whose first frame is put at x = z = 0, and who is turned to
// face z there:
//
//     0        half of the turn about y from t to t + 1, radians
//     1 -   2  x and z of the root's way from t to t + 1, in the heading of t + 1, metres
//     3        height of the root
//     4 -  66  joints 1 to 21 relative to the root's x and z, in the heading of t
//    67 - 192  rotations of joints 1 to 21 as six numbers, by the definition's own inverse
//              kinematics: along each of five chains, the smallest rotation from a fixed direction
//              to the bone, relative to the one before
//   193 - 258  the way of joints 0 to 21 from t to t + 1, in the heading of t
//   259 - 262  1 if left ankle, left ball, right ankle, right ball of the foot stay (the square of
//              their way is less than 0.002)
//
// The last frame is dropped. The heading comes from the shoulders minus the hips, filtered by a
// Gaussian of 20 frames. The features keep neither the initial heading nor the place nor the floor.
//
// Source: Guo et al. 2022, "Generating diverse and natural 3D human motions from text", and
// motion_representation.ipynb of github.com/EricGuo5513/HumanML3D, written anew from its
// definition. Two differences: the data set first moves everybody onto the bones of one of its
// captures, which is not done here. And in the one frame in which a person turns past the
// direction opposite to z, the notebook writes the turn with the wrong sign; here it is right.

namespace duet::formats::research {

inline constexpr int kHumanMl3dWidth = 263;

// Shapes: [frames - 1, 263], row-major. Requires at least two frames. Units: metres, y up.
std::vector<float> HumanMl3dFeatures(const std::vector<BodyPose>& poses);

// The positions that the numbers 0 to 66 describe. [frames] from [frames, 263]
std::vector<BodyPose> FromHumanMl3dFeatures(absl::Span<const double> features);

// What FromHumanMl3dFeatures returns for the features of these poses, up to rounding.
std::vector<BodyPose> KeptByHumanMl3d(const std::vector<BodyPose>& poses);

}  // namespace duet::formats::research

#endif  // DUET_MODEL_FORMATS_RESEARCH_HUMANML3D_FEATURES_H_
