#ifndef DUET_MODEL_RETARGETING_EULER_H_
#define DUET_MODEL_RETARGETING_EULER_H_

#include <array>
#include <vector>

#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// Three different axes (0 x, 1 y, 2 z): R = R(axes[0]) R(axes[1]) R(axes[2]); axes[2] applies
// first.
using EulerOrder = std::array<int, 3>;
// Radians, in the same order as the axes.
using EulerAngles = std::array<double, 3>;

Quaternion FromEuler(EulerAngles angles, EulerOrder order);
// The angles of `q` nearest to `previous` among both solutions plus multiples of 2 pi, so that a
// smooth motion has smooth angles. In gimbal lock the middle angle is +-pi / 2 and the others share
// an axis: the last angle then keeps its previous value.
EulerAngles ToEuler(Quaternion q, EulerOrder order, EulerAngles previous);

// The angles of every frame, each nearest to the previous frame's. The free angle in gimbal lock is
// interpolated from its value before to its value after. Shapes: [frames] to [frames].
std::vector<EulerAngles> ToEulerTrack(const std::vector<Quaternion>& turns, EulerOrder order);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_EULER_H_
