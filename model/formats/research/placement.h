#ifndef DUET_MODEL_FORMATS_RESEARCH_PLACEMENT_H_
#define DUET_MODEL_FORMATS_RESEARCH_PLACEMENT_H_

#include <array>
#include <vector>

#include "model/motion/clip.h"
#include "model/retargeting/rotation.h"

// What the features of HumanML3D and InterGen have in common: where they put a motion, the feet
// that touch the floor, and rotations as six numbers. People have the joints of BodySkeleton().

namespace duet::formats::research {

// The positions of one frame. [kBodyJoints]
using BodyPose = std::vector<retargeting::Vec3d>;

// [frames]
std::vector<BodyPose> ToDouble(const motion::Clip& body);
motion::Clip ToClip(const std::vector<BodyPose>& poses, double frame_rate_hz);

// Moves and turns a motion: Rotate(turn, position - origin).
struct Placement {
  retargeting::Vec3d origin;
  retargeting::Quaternion turn;
};
std::vector<BodyPose> Place(const Placement& placement, const std::vector<BodyPose>& poses);

// The lowest position of any joint in any frame.
double FloorOf(const std::vector<BodyPose>& poses);

// The horizontal direction across which a person stands: y x `across`, of length 1; z if there is
// none. `across` points from left to right.
retargeting::Vec3d Ahead(retargeting::Vec3d across);
// The smallest rotation that takes `ahead` to z.
retargeting::Quaternion TurnToZ(retargeting::Vec3d ahead);

// The first two columns of the rotation's matrix, one after the other.
//
// Source: Zhou et al. 2019, "On the continuity of rotation representations in neural networks".
std::array<double, 6> SixNumbers(retargeting::Quaternion rotation);

// Whether the left ankle, left ball, right ankle and right ball of the foot stay: from this frame
// to the next, the square of their way is less than `most_squared`.
std::array<bool, 4> FeetStay(const BodyPose& pose, const BodyPose& next, double most_squared);

}  // namespace duet::formats::research

#endif  // DUET_MODEL_FORMATS_RESEARCH_PLACEMENT_H_
