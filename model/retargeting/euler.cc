#include "model/retargeting/euler.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace duet::retargeting {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Cosine of the middle angle below which only the sum of the others is defined.
constexpr double kGimbalLock = 1e-5;

Vec3d AxisOf(int axis) {
  return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
}

double Component(Vec3d a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }

// `angle` plus the whole turns that bring it nearest to `previous`.
EulerAngles Nearest(EulerAngles angles, const EulerAngles& previous) {
  for (std::size_t i = 0; i < angles.size(); ++i) {
    angles[i] += 2 * kPi * std::round((previous[i] - angles[i]) / (2 * kPi));
  }
  return angles;
}

double SquaredDifference(const EulerAngles& a, const EulerAngles& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

}  // namespace

Quaternion FromEuler(EulerAngles angles, EulerOrder order) {
  Quaternion q;
  for (std::size_t i = 0; i < order.size(); ++i) q = q * AxisAngle(AxisOf(order[i]), angles[i]);
  return q;
}

EulerAngles ToEuler(Quaternion q, EulerOrder order, EulerAngles previous) {
  const auto [i, j, k] = order;
  // Of the rotation matrix.
  const auto at = [&q](int row, int column) { return Component(Rotate(q, AxisOf(column)), row); };
  const double parity = (i + 1) % 3 == j ? 1 : -1;
  const double sine = std::clamp(parity * at(i, k), -1.0, 1.0);
  const double cosine = std::hypot(at(i, i), at(i, j));
  if (cosine < kGimbalLock) {
    const double sign = sine > 0 ? 1 : -1;
    const double sum = std::atan2(parity * at(k, j), at(j, j));
    return Nearest({sum - parity * sign * previous[2], sign * kPi / 2, previous[2]}, previous);
  }
  const EulerAngles first = {std::atan2(-parity * at(j, k), at(k, k)), std::atan2(sine, cosine),
                             std::atan2(-parity * at(i, j), at(i, i))};
  const EulerAngles second = {first[0] + kPi, kPi - first[1], first[2] + kPi};
  const EulerAngles a = Nearest(first, previous), b = Nearest(second, previous);
  return SquaredDifference(a, previous) <= SquaredDifference(b, previous) ? a : b;
}

}  // namespace duet::retargeting
