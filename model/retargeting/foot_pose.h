#ifndef DUET_MODEL_RETARGETING_FOOT_POSE_H_
#define DUET_MODEL_RETARGETING_FOOT_POSE_H_

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/rotation.h"

// The rotation of feet from the positions of ankles and, where a motion has them, toes.

namespace duet::retargeting {

// The height of a standing ankle: a low quantile over both feet and all frames, so that a foot that
// never comes down does not matter. 0 without feet.
double AnkleHeightOnFloor(const motion::Skeleton& skeleton, const motion::Clip& clip);
// The same for any pair of joints.
double HeightOnFloor(motion::JointPair joints, const motion::Clip& clip);

// The usual height of an ankle above the sole, metres.
inline constexpr double kUsualAnkleHeight = 0.06;

// The distance from ankles to soles for a person who stands on the floor, y = 0:
// `ankle_height_on_floor`, or kUsualAnkleHeight if that is no plausible ankle height, as in
// captures without a calibrated floor. Unit: metres.
double SoleDepth(double ankle_height_on_floor);

// The foot's rotation in the world; at rest the foot points along +z with y up. `shin` is the
// shin's rotation; at rest the shin hangs down and faces +z. In the air the foot is at a right
// angle to the shin; on the floor it is level.
Quaternion FootRotation(Quaternion shin, Vec3d ankle, double ankle_height_on_floor);

// The slope of a standing foot from its ankle down to its toe, radians: the median over the frames
// in which the ankles are lowest. Requires at least one frame.
double FootSlopeOnFloor(motion::JointPair ankles, motion::JointPair toes, const motion::Clip& clip);

// The foot's rotation in the world if the position of its toe is known: it points at the toe, level
// on the floor if the slope is `slope_on_floor`. `without_toe` is the rotation that FootRotation
// returns; it defines the foot's turn about itself.
Quaternion FootRotationWithToe(Quaternion without_toe, Vec3d ankle, Vec3d toe,
                               double slope_on_floor);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_FOOT_POSE_H_
