#include "model/retargeting/rotation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/angle.h"

namespace duet::retargeting {
namespace {

using base::kPi;
constexpr double kTiny = 1e-12;
constexpr double kNearlyEqual = 1e-4;  // radians

// Over quaternions as (x, y, z, w): of equal eigenvalues, that of no rotation is then the last.
using Matrix4 = Eigen::Matrix4d;

// The symmetric matrix of a correspondence (Horn 1987).
Matrix4 MatrixOf(const Correspondence& c) {
  const Vec3d f = c.from * c.weight, t = c.to, axis = Cross(f, t);
  const double xx = f.x * t.x, yy = f.y * t.y, zz = f.z * t.z;
  const double xy = f.x * t.y + f.y * t.x, xz = f.x * t.z + f.z * t.x, yz = f.y * t.z + f.z * t.y;
  Matrix4 m;
  m << xx - yy - zz, xy, xz, axis.x,  //
      xy, yy - xx - zz, yz, axis.y,   //
      xz, yz, zz - xx - yy, axis.z,   //
      axis.x, axis.y, axis.z, xx + yy + zz;
  return m;
}

// trace(R^T P) = 4 dot(q, p)^2 - 1.
Matrix4 MatrixOf(const RotationPrior& prior) {
  const Quaternion q = prior.rotation;
  const Eigen::Vector4d p(q.x, q.y, q.z, q.w);
  return 4 * prior.weight * p * p.transpose();
}

}  // namespace

Vec3d Unit(Vec3d a, Vec3d fallback) {
  const double norm = Norm(a);
  return norm > kTiny ? a * (1 / norm) : fallback;
}

Quaternion operator*(Quaternion a, Quaternion b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

double Dot(Quaternion a, Quaternion b) { return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z; }

Quaternion Inverse(Quaternion q) { return {q.w, -q.x, -q.y, -q.z}; }

Quaternion Normalised(Quaternion q) {
  const double norm = std::sqrt(Dot(q, q));
  if (!(norm > kTiny)) return {};
  return {q.w / norm, q.x / norm, q.y / norm, q.z / norm};
}

Vec3d Rotate(Quaternion q, Vec3d a) {
  const Vec3d u{q.x, q.y, q.z};
  const Vec3d t = Cross(u, a) * 2;
  return a + t * q.w + Cross(u, t);
}

double Angle(Quaternion a, Quaternion b) {
  return 2 * std::acos(std::min(1.0, std::abs(Dot(a, b))));
}

Quaternion AxisAngle(Vec3d unit_axis, double radians) {
  const double s = std::sin(radians / 2);
  return {std::cos(radians / 2), unit_axis.x * s, unit_axis.y * s, unit_axis.z * s};
}

Quaternion FromAxes(Vec3d x, Vec3d y, Vec3d z) {
  return FitRotation({{{1, 0, 0}, x}, {{0, 1, 0}, y}, {{0, 0, 1}, z}}, {});
}

Quaternion Slerp(Quaternion a, Quaternion b, double share) {
  const double cosine = Dot(a, b), side = cosine < 0 ? -1 : 1;
  const double angle = std::acos(std::min(1.0, std::abs(cosine)));
  // For nearly equal rotations, linear interpolation is accurate.
  const bool line = angle < kNearlyEqual;
  const double from = line ? 1 - share : std::sin((1 - share) * angle);
  const double to = side * (line ? share : std::sin(share * angle));
  return Normalised(
      {from * a.w + to * b.w, from * a.x + to * b.x, from * a.y + to * b.y, from * a.z + to * b.z});
}

Quaternion ShortestArc(Vec3d from, Vec3d to, Vec3d axis_if_opposite) {
  const Vec3d half = from + to;
  if (Norm(half) < 1e-9) return AxisAngle(axis_if_opposite, kPi);
  // The half-way direction avoids the cancellation of 1 + dot(from, to) near opposite directions.
  const Vec3d middle = Unit(half, from);
  const Vec3d axis = Cross(from, middle);
  return Normalised({Dot(from, middle), axis.x, axis.y, axis.z});
}

Quaternion FitRotation(const std::vector<Correspondence>& correspondences,
                       const std::vector<RotationPrior>& priors) {
  Matrix4 m = Matrix4::Zero();
  for (const Correspondence& correspondence : correspondences) m += MatrixOf(correspondence);
  for (const RotationPrior& prior : priors) m += MatrixOf(prior);
  // In increasing order of the eigenvalues.
  const Eigen::Vector4d q = Eigen::SelfAdjointEigenSolver<Matrix4>(m).eigenvectors().col(3);
  const double side = q[3] < 0 ? -1 : 1;
  return Normalised({side * q[3], side * q[0], side * q[1], side * q[2]});
}

namespace {

// Cosine of the middle angle below which only the sum of the others is defined.
constexpr double kGimbalLock = 1e-5;

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
  const Vec3d i = Rotate(q, UnitAxis(order[0])), j = Rotate(q, UnitAxis(order[1]));
  return std::hypot(Component(i, order[0]), Component(j, order[0]));
}

}  // namespace

Quaternion FromEuler(EulerAngles angles, EulerOrder order) {
  Quaternion q;
  for (std::size_t i = 0; i < order.size(); ++i) q = q * AxisAngle(UnitAxis(order[i]), angles[i]);
  return q;
}

EulerAngles ToEuler(Quaternion q, EulerOrder order, EulerAngles previous) {
  const auto [i, j, k] = order;
  // An element of the rotation matrix.
  const auto at = [&q](int row, int column) { return Component(Rotate(q, UnitAxis(column)), row); };
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
  std::vector<EulerAngles> track;
  for (const Quaternion& turn : turns) {
    track.push_back(ToEuler(turn, order, track.empty() ? EulerAngles{} : track.back()));
  }
  return track;
}

}  // namespace duet::retargeting
