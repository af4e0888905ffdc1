#ifndef DUET_MODEL_FORMATS_FLAT_ROTATION_FORM_H_
#define DUET_MODEL_FORMATS_FLAT_ROTATION_FORM_H_

#include <array>

#include "model/motion/joint_rotations.h"

namespace duet::formats::flat {

// How a file holds rotations: unit quaternions x, y, z, w, or six numbers (SixNumbers).
enum class RotationForm { kQuaternions, kSixNumbers };

// The first two columns of the rotation's matrix, one after the other: R00 R10 R20 R01 R11 R21.
//
// Source: Zhou et al. 2019, "On the continuity of rotation representations in neural networks".
inline std::array<float, 6> SixNumbers(const motion::UnitQuaternion& q) {
  return {1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.w * q.z),
          2 * (q.x * q.z - q.w * q.y),     2 * (q.x * q.y - q.w * q.z),
          1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z + q.w * q.x)};
}

}  // namespace duet::formats::flat

#endif  // DUET_MODEL_FORMATS_FLAT_ROTATION_FORM_H_
