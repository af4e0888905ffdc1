#ifndef DUET_MODEL_RETARGETING_EULER_H_
#define DUET_MODEL_RETARGETING_EULER_H_

#include <array>

#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// Three different axes (0 x, 1 y, 2 z): R = R(axes[0]) R(axes[1]) R(axes[2]), the last one first.
using EulerOrder = std::array<int, 3>;
// Radians, in the order's order.
using EulerAngles = std::array<double, 3>;

Quaternion FromEuler(EulerAngles angles, EulerOrder order);
// The angles of `q` nearest to `previous`: of the two solutions and all their whole turns, so that
// a smooth motion has smooth angles. In gimbal lock the last angle stays as it was.
EulerAngles ToEuler(Quaternion q, EulerOrder order, EulerAngles previous);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_EULER_H_
