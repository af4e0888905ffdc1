#ifndef DUET_MODEL_RETARGETING_AFFINE_H_
#define DUET_MODEL_RETARGETING_AFFINE_H_

#include <cmath>
#include <limits>
#include <optional>

#include "model/retargeting/rotation.h"

namespace duet::retargeting {

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

// Absent if the map has no volume.
inline std::optional<Affine> Inverse(const Affine& map) {
  const double volume = Dot(Cross(map.x, map.y), map.z);
  if (!(std::abs(volume) > std::numeric_limits<double>::min())) return std::nullopt;
  const Vec3d a = Cross(map.y, map.z) * (1 / volume), b = Cross(map.z, map.x) * (1 / volume),
              c = Cross(map.x, map.y) * (1 / volume);
  Affine inverse{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}, {}};
  inverse.origin = -inverse.Turn(map.origin);
  return inverse;
}

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

// The parts of a map without shear. A mirroring map gets three negative scales.
inline Parts ToParts(const Affine& map) {
  const double sign = Dot(Cross(map.x, map.y), map.z) < 0 ? -1 : 1;
  return {map.origin,
          FromAxes(Unit(map.x * sign, {1, 0, 0}), Unit(map.y * sign, {0, 1, 0}),
                   Unit(map.z * sign, {0, 0, 1})),
          {sign * Norm(map.x), sign * Norm(map.y), sign * Norm(map.z)}};
}

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_AFFINE_H_
