#include "model/retargeting/rotation.h"

#include <algorithm>
#include <array>

#include "model/base/angle.h"

namespace duet::retargeting {
namespace {

using base::kPi;
constexpr double kTiny = 1e-12;
constexpr double kNearlyEqual = 1e-4;  // radians
constexpr int kMaxSweeps = 32;

using Matrix4 = std::array<std::array<double, 4>, 4>;

// One Jacobi rotation: makes m[p][q] zero, and keeps the eigenvectors in the columns of v.
void RotateOut(int p, int q, Matrix4* m, Matrix4* v) {
  Matrix4& a = *m;
  const auto at = [&a](int row, int column) -> double& {
    return a[static_cast<size_t>(row)][static_cast<size_t>(column)];
  };
  if (std::abs(at(p, q)) < 1e-300) return;
  const double theta = (at(q, q) - at(p, p)) / (2 * at(p, q));
  const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  for (int k = 0; k < 4; ++k) {
    const double kp = at(k, p), kq = at(k, q);
    at(k, p) = c * kp - s * kq;
    at(k, q) = s * kp + c * kq;
  }
  for (int k = 0; k < 4; ++k) {
    const double pk = at(p, k), qk = at(q, k);
    at(p, k) = c * pk - s * qk;
    at(q, k) = s * pk + c * qk;
  }
  for (auto& row : *v) {
    const double kp = row[static_cast<size_t>(p)], kq = row[static_cast<size_t>(q)];
    row[static_cast<size_t>(p)] = c * kp - s * kq;
    row[static_cast<size_t>(q)] = s * kp + c * kq;
  }
}

// The eigenvector of the largest eigenvalue of a symmetric matrix.
Quaternion LargestEigenvector(Matrix4 m) {
  Matrix4 v = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    double off_diagonal = 0, diagonal = 0;
    for (size_t i = 0; i < 4; ++i) {
      diagonal += m[i][i] * m[i][i];
      for (size_t j = i + 1; j < 4; ++j) off_diagonal += m[i][j] * m[i][j];
    }
    if (off_diagonal <= 1e-30 * diagonal) break;
    for (int p = 0; p < 3; ++p) {
      for (int q = p + 1; q < 4; ++q) RotateOut(p, q, &m, &v);
    }
  }
  size_t best = 0;
  for (size_t i = 1; i < 4; ++i) best = m[i][i] > m[best][best] ? i : best;
  return Normalised({v[0][best], v[1][best], v[2][best], v[3][best]});
}

void Add(const Correspondence& c, Matrix4* m) {
  const Vec3d f = c.from * c.weight, t = c.to;
  Matrix4& a = *m;
  a[0][0] += f.x * t.x + f.y * t.y + f.z * t.z;
  a[1][1] += f.x * t.x - f.y * t.y - f.z * t.z;
  a[2][2] += -f.x * t.x + f.y * t.y - f.z * t.z;
  a[3][3] += -f.x * t.x - f.y * t.y + f.z * t.z;
  a[0][1] += f.y * t.z - f.z * t.y;
  a[0][2] += f.z * t.x - f.x * t.z;
  a[0][3] += f.x * t.y - f.y * t.x;
  a[1][2] += f.x * t.y + f.y * t.x;
  a[1][3] += f.z * t.x + f.x * t.z;
  a[2][3] += f.y * t.z + f.z * t.y;
}

// trace(R^T P) = 4 dot(q, p)^2 - 1.
void Add(const RotationPrior& prior, Matrix4* m) {
  const double p[] = {prior.rotation.w, prior.rotation.x, prior.rotation.y, prior.rotation.z};
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = i; j < 4; ++j) (*m)[i][j] += 4 * prior.weight * p[i] * p[j];
  }
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
  Matrix4 m = {};
  for (const Correspondence& correspondence : correspondences) Add(correspondence, &m);
  for (const RotationPrior& prior : priors) Add(prior, &m);
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < i; ++j) m[i][j] = m[j][i];
  }
  return LargestEigenvector(m);
}

}  // namespace duet::retargeting
