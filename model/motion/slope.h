#ifndef DUET_MODEL_MOTION_SLOPE_H_
#define DUET_MODEL_MOTION_SLOPE_H_

#include <cmath>

// Normally distributed slopes of a vertical: the algebra of vertical.h.

namespace duet::motion {

// How far a direction leans from +y, as tangents of its angles towards +x and +z.
struct Slope {
  double x = 0;
  double z = 0;
};

// Normal equations of a slope: a symmetric matrix and the right-hand side.
struct Information {
  double xx = 0, xz = 0, zz = 0;
  double x = 0, z = 0;

  Information& operator+=(const Information& o) {
    xx += o.xx;
    xz += o.xz;
    zz += o.zz;
    x += o.x;
    z += o.z;
    return *this;
  }
};

// A slope with its covariance.
struct SlopeEstimate {
  Slope mean;
  double xx = 0, xz = 0, zz = 0;

  // The standard error in the least certain direction.
  double LargestError() const { return std::sqrt((xx + zz) / 2 + std::hypot((xx - zz) / 2, xz)); }
  // The length of `slope` in standard errors.
  double Deviations(Slope slope) const {
    const double determinant = xx * zz - xz * xz;
    return std::sqrt(
        (zz * slope.x * slope.x - 2 * xz * slope.x * slope.z + xx * slope.z * slope.z) /
        determinant);
  }
};

// Solves the normal equations. Requires an invertible matrix.
inline SlopeEstimate Solve(const Information& in) {
  const double determinant = in.xx * in.zz - in.xz * in.xz;
  const double xx = in.zz / determinant, xz = -in.xz / determinant, zz = in.xx / determinant;
  return {{xx * in.x + xz * in.z, xz * in.x + zz * in.z}, xx, xz, zz};
}

// The inverse of Solve.
inline Information ToInformation(const SlopeEstimate& slope) {
  const SlopeEstimate inverse = Solve({slope.xx, slope.xz, slope.zz, slope.mean.x, slope.mean.z});
  return {inverse.xx, inverse.xz, inverse.zz, inverse.mean.x, inverse.mean.z};
}

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_SLOPE_H_
