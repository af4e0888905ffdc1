#ifndef DUET_MODEL_RETARGETING_ROTATION_H_
#define DUET_MODEL_RETARGETING_ROTATION_H_

#include <array>
#include <cmath>
#include <vector>

#include "model/motion/vec3.h"

namespace duet::retargeting {

struct Vec3d {
  double x = 0, y = 0, z = 0;

  friend Vec3d operator+(Vec3d a, Vec3d b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3d operator-(Vec3d a, Vec3d b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3d operator-(Vec3d a) { return {-a.x, -a.y, -a.z}; }
  friend Vec3d operator*(Vec3d a, double s) { return {a.x * s, a.y * s, a.z * s}; }
  Vec3d& operator+=(Vec3d o) { return *this = *this + o; }
};

inline Vec3d ToDouble(motion::Vec3 a) { return {a.x, a.y, a.z}; }
inline motion::Vec3 ToFloat(Vec3d a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}
inline double Dot(Vec3d a, Vec3d b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3d Cross(Vec3d a, Vec3d b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double Norm(Vec3d a) { return std::sqrt(Dot(a, a)); }
// `a` scaled to length 1, or `fallback` if it is too short to have a direction.
Vec3d Unit(Vec3d a, Vec3d fallback);

// Of the axes 0 x, 1 y, 2 z: the unit vector along it, and the component of `a`.
inline Vec3d UnitAxis(int axis) {
  return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
}
inline double& Component(Vec3d& a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }
inline double Component(const Vec3d& a, int axis) {
  return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

// A unit quaternion; q and -q are the same rotation.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;

  friend Quaternion operator*(Quaternion a, Quaternion b);  // applies b first, then a
};

double Dot(Quaternion a, Quaternion b);
Quaternion Inverse(Quaternion q);
// `q` scaled to norm 1, or no rotation if its norm is near zero.
Quaternion Normalised(Quaternion q);
Vec3d Rotate(Quaternion q, Vec3d a);
// The angle between two rotations, 0 to pi.
double Angle(Quaternion a, Quaternion b);
Quaternion AxisAngle(Vec3d unit_axis, double radians);
// The rotation that takes the world axes to the right-handed orthonormal axes x, y, z.
Quaternion FromAxes(Vec3d x, Vec3d y, Vec3d z);
// Interpolates from a (share 0) to b (share 1) along the shorter arc at constant speed.
Quaternion Slerp(Quaternion a, Quaternion b, double share);
// The smallest rotation between two unit directions. Opposite directions rotate about
// `axis_if_opposite`, a unit vector perpendicular to `from`.
Quaternion ShortestArc(Vec3d from, Vec3d to, Vec3d axis_if_opposite);

// A direction or point `from` that a rotation is fitted to take to `to`.
struct Correspondence {
  Vec3d from;
  Vec3d to;
  double weight = 1;
};
// A rotation near the expected result; it decides what the correspondences do not determine.
struct RotationPrior {
  Quaternion rotation;
  double weight = 0;
};
// The rotation R that maximises sum weight dot(to, R from) + sum prior weight trace(R^T prior).
//
// Source: Horn 1987 (quaternion form of Kabsch's problem): the largest eigenvector of a 4 x 4
// matrix.
Quaternion FitRotation(const std::vector<Correspondence>& correspondences,
                       const std::vector<RotationPrior>& priors);

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

// The angles of every frame, each nearest to the previous frame's. Shapes: [frames] to [frames].
std::vector<EulerAngles> ToEulerTrack(const std::vector<Quaternion>& turns, EulerOrder order);

// An affine map: the images of the axes and of the origin.
struct Affine {
  Vec3d x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1}, origin;

  Vec3d Turn(Vec3d a) const { return x * a.x + y * a.y + z * a.z; }
  // Applies `inner` first, then this map.
  Affine operator*(const Affine& inner) const {
    return {Turn(inner.x), Turn(inner.y), Turn(inner.z), origin + Turn(inner.origin)};
  }
  // The mean factor by which lengths along the axes grow.
  double Scale() const { return (Norm(x) + Norm(y) + Norm(z)) / 3; }
};

// Translation * rotation * scale, as hierarchies of nodes compose them.
struct Parts {
  Vec3d translation;
  Quaternion rotation;
  Vec3d scale = {1, 1, 1};
};

inline Affine FromParts(const Parts& parts) {
  return {Rotate(parts.rotation, {1, 0, 0}) * parts.scale.x,
          Rotate(parts.rotation, {0, 1, 0}) * parts.scale.y,
          Rotate(parts.rotation, {0, 0, 1}) * parts.scale.z, parts.translation};
}

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_ROTATION_H_
