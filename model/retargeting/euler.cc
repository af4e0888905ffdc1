#include "model/retargeting/euler.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/angle.h"

namespace duet::retargeting {
namespace {

using base::kPi;
// Cosine of the middle angle below which only the sum of the others is defined.
constexpr double kGimbalLock = 1e-5;

Vec3d AxisOf(int axis) {
  return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
}

double Component(Vec3d a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }

// `angle` plus the multiple of 2 pi that brings it nearest to `previous`.
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

// Cosine of the middle angle.
double MiddleCosine(Quaternion q, EulerOrder order) {
  const Vec3d i = Rotate(q, AxisOf(order[0])), j = Rotate(q, AxisOf(order[1]));
  return std::hypot(Component(i, order[0]), Component(j, order[0]));
}

bool InGimbalLock(Quaternion q, EulerOrder order) { return MiddleCosine(q, order) < kGimbalLock; }

// Interpolates the angles of frames `begin` to `end`, all in gimbal lock, between those before and
// after. The last angle changes within the lock, where that does not change the pose. A single
// frame gets half the change.
void FillLock(const std::vector<Quaternion>& turns, EulerOrder order, std::size_t begin,
              std::size_t end, std::vector<EulerAngles>* track) {
  EulerAngles angles = begin > 0 ? (*track)[begin - 1] : EulerAngles{};
  double last = angles[2], step = 0;
  if (end < turns.size()) {
    const EulerAngles after = ToEuler(turns[end], order, ToEuler(turns[end - 1], order, angles));
    if (begin == 0) {
      last = after[2];
    } else if (end - begin == 1) {
      last = (last + after[2]) / 2;
    } else {
      step = (after[2] - last) / static_cast<double>(end - begin - 1);
    }
  }
  for (std::size_t frame = begin; frame < end; ++frame, last += step) {
    angles = ToEuler(turns[frame], order, {angles[0], angles[1], last});
    (*track)[frame] = angles;
  }
}

}  // namespace

Quaternion FromEuler(EulerAngles angles, EulerOrder order) {
  Quaternion q;
  for (std::size_t i = 0; i < order.size(); ++i) q = q * AxisAngle(AxisOf(order[i]), angles[i]);
  return q;
}

EulerAngles ToEuler(Quaternion q, EulerOrder order, EulerAngles previous) {
  const auto [i, j, k] = order;
  // An element of the rotation matrix.
  const auto at = [&q](int row, int column) { return Component(Rotate(q, AxisOf(column)), row); };
  const double parity = (i + 1) % 3 == j ? 1 : -1;
  const double sine = std::clamp(parity * at(i, k), -1.0, 1.0);
  const double cosine = MiddleCosine(q, order);
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

std::vector<EulerAngles> ToEulerTrack(const std::vector<Quaternion>& turns, EulerOrder order) {
  std::vector<EulerAngles> track(turns.size());
  for (std::size_t frame = 0; frame < turns.size(); ++frame) {
    std::size_t end = frame;
    while (end < turns.size() && InGimbalLock(turns[end], order)) ++end;
    if (end > frame) {
      FillLock(turns, order, frame, end, &track);
      frame = end - 1;
    } else {
      track[frame] = ToEuler(turns[frame], order, frame > 0 ? track[frame - 1] : EulerAngles{});
    }
  }
  return track;
}

}  // namespace duet::retargeting
