#ifndef DUET_MODEL_RETARGETING_EULER_H_
#define DUET_MODEL_RETARGETING_EULER_H_

#include <array>
#include <cstddef>
#include <vector>

#include "model/retargeting/rotation.h"

namespace duet::retargeting {

// Three different axes (0 x, 1 y, 2 z): R = R(axes[0]) R(axes[1]) R(axes[2]), the last one first.
using EulerOrder = std::array<int, 3>;
// Radians, in the order's order.
using EulerAngles = std::array<double, 3>;

Quaternion FromEuler(EulerAngles angles, EulerOrder order);
// The angles of `q` nearest to `previous`: of the two solutions and all their whole turns, so that
// a smooth motion has smooth angles. In gimbal lock, where the middle angle is a quarter turn and
// the others turn about one axis, the last angle stays as it was.
EulerAngles ToEuler(Quaternion q, EulerOrder order, EulerAngles previous);

// The angles of every frame, each nearest to those before; what gimbal lock leaves open turns
// evenly from what it was before to what it has to be after. Shapes: [frames] to [frames].
std::vector<EulerAngles> ToEulerTrack(const std::vector<Quaternion>& turns, EulerOrder order);

// `keys` steps from each frame to the next, where one was. [frames] to [keys (frames - 1) + 1]
std::vector<Quaternion> WithKeysBetween(const std::vector<Quaternion>& turns, int keys);

// How far a program is off that draws straight lines between angles, half way from `frame` to the
// next: from the rotation half way between both.
struct InBetween {
  double radians = 0;
  std::size_t frame = 0;
};
// Where it is the most. `track` is ToEulerTrack(turns, order).
InBetween LargestInBetween(const std::vector<Quaternion>& turns,
                           const std::vector<EulerAngles>& track, EulerOrder order);

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_EULER_H_
