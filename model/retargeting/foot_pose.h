#ifndef DUET_MODEL_RETARGETING_FOOT_POSE_H_
#define DUET_MODEL_RETARGETING_FOOT_POSE_H_

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/rotation.h"

// Which way feet point, where nothing but the ankle is known.

namespace duet::retargeting {

// How high ankles are when they stand: lower than in nearly every frame. Of both feet over the
// clip, so that one that never comes down does not count. Without feet 0.
double AnkleHeightOnFloor(const motion::Skeleton& skeleton, const motion::Clip& clip);

// The usual height of an ankle above the sole, metres.
inline constexpr double kUsualAnkleHeight = 0.06;

// How far below the ankles the soles are if whoever stands so stands on the floor, y = 0:
// `ankle_height_on_floor` itself, or kUsualAnkleHeight where that is no ankle's height, as in
// captures without a floor of their own. Unit: metres.
double SoleDepth(double ankle_height_on_floor);

// The foot's rotation in the world, which at rest points along +z with y up. `shin` is the shin's,
// which at rest hangs down and faces +z. The foot is at a right angle to the shin in the air and
// level where it stands.
Quaternion FootRotation(Quaternion shin, Vec3d ankle, double ankle_height_on_floor);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_FOOT_POSE_H_
