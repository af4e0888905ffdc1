#ifndef DUET_MODEL_MOTION_VEC3_H_
#define DUET_MODEL_MOTION_VEC3_H_

#include <cmath>

namespace duet::motion {

// A point or direction. Metres in a right-handed, y-up world unless the owner specifies otherwise.
struct Vec3 {
  float x = 0;
  float y = 0;
  float z = 0;

  friend Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
  friend Vec3 operator*(float s, Vec3 a) { return a * s; }
  friend Vec3 operator/(Vec3 a, float s) { return {a.x / s, a.y / s, a.z / s}; }
  Vec3& operator+=(Vec3 o) { return *this = *this + o; }
  Vec3& operator-=(Vec3 o) { return *this = *this - o; }
  friend bool operator==(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
  friend bool operator!=(Vec3 a, Vec3 b) { return !(a == b); }
};

inline float Dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 Cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float Norm(Vec3 a) { return std::sqrt(Dot(a, a)); }
inline float Distance(Vec3 a, Vec3 b) { return Norm(a - b); }
// a + (b - a) t
inline Vec3 Lerp(Vec3 a, Vec3 b, float t) { return a + (b - a) * t; }
inline bool IsFinite(Vec3 a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
// Rotates `a` by `radians` about +y, counter-clockwise seen from above (+z goes to +x).
inline Vec3 RotateY(Vec3 a, double radians) {
  const float c = static_cast<float>(std::cos(radians));
  const float s = static_cast<float>(std::sin(radians));
  return {c * a.x + s * a.z, a.y, -s * a.x + c * a.z};
}

// Rotates `a` by `radians` about an axis of length 1, counter-clockwise seen from its tip
// (Rodrigues).
inline Vec3 RotateAbout(Vec3 a, Vec3 axis, double radians) {
  const float c = static_cast<float>(std::cos(radians));
  const float s = static_cast<float>(std::sin(radians));
  return a * c + Cross(axis, a) * s + axis * (Dot(axis, a) * (1 - c));
}

// Positions are read and written as flat lists of x, y, z.
static_assert(sizeof(Vec3) == 3 * sizeof(float), "Vec3 must be three packed floats");

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_VEC3_H_
