#include "model/motion/levelling.h"

#include <cmath>

namespace duet::motion {
namespace {

Vec3 FromDoubles(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

}  // namespace

Levelling::Levelling(Vec3 up, float floor_height) : floor_height_(floor_height) {
  const double length = std::sqrt(double{up.x} * up.x + double{up.y} * up.y + double{up.z} * up.z);
  const double x = up.x / length, y = up.y / length, z = up.z / length;
  // The shortest rotation from (x, y, z) to +y, in closed form.
  row_x_ = FromDoubles(1 - x * x / (1 + y), -x, -x * z / (1 + y));
  up_ = FromDoubles(x, y, z);
  row_z_ = FromDoubles(-x * z / (1 + y), -z, 1 - z * z / (1 + y));
}

Vec3 Levelling::Apply(Vec3 captured) const {
  return {Dot(row_x_, captured), Dot(up_, captured) - floor_height_, Dot(row_z_, captured)};
}

Vec3 Levelling::Invert(Vec3 level) const {
  return level.x * row_x_ + (level.y + floor_height_) * up_ + level.z * row_z_;
}

Poses Levelling::Apply(Poses captured) const {
  for (Vec3& position : captured.all()) position = Apply(position);
  return captured;
}

Poses Levelling::Invert(Poses level) const {
  for (Vec3& position : level.all()) position = Invert(position);
  return level;
}

}  // namespace duet::motion
