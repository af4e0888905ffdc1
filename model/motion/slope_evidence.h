#ifndef DUET_MODEL_MOTION_SLOPE_EVIDENCE_H_
#define DUET_MODEL_MOTION_SLOPE_EVIDENCE_H_

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

// The two kinds of evidence of vertical.h, and their algebra: normally distributed slopes of a
// vertical.

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

// The floor's slope from the places where feet rest: a plane is fitted to them. Each foot of each
// person has its own height above the plane, because captures place left and right feet, and the
// feet of two people, at different heights. So only a foot that rests in several places is
// evidence, and only for the slope along them. The error grows with the scatter about the plane:
// depth cameras scatter, and bend, a floor.
class FloorEvidence {
 public:
  // Requires feet and poses in the skeleton's joint order.
  void Add(const Skeleton& skeleton, const Clip& person);
  // The slope of the floor's normal. Absent if no foot rests in several places.
  std::optional<SlopeEstimate> Estimate() const;
  // How many; a place counts once for each foot.
  int place_count() const { return static_cast<int>(places_.size()); }

 private:
  // Where a foot rests.
  struct Place {
    std::size_t foot = 0;
    double x = 0, y = 0, z = 0;
    double weight = 1;
  };

  void AddFoot(const Clip& person, int joint);
  std::vector<Place> Centred(const std::vector<Place>& places) const;
  double Scatter(const std::vector<double>& residuals, const std::vector<Place>& centred) const;
  static Information NormalEquations(const std::vector<Place>& centred);

  std::vector<Place> places_;
  std::size_t feet_ = 0;  // that rest in several places
};

// The vertical's slope from the directions in which people stand, from the middle of the feet to
// the neck. In a block of half a second, a person's direction is the sum of
//
//   the vertical's slope   the same for everybody, whichever way they face
//   a habit                how people stand: the same for all, relative to the way they face
//   the person's own lean  relative to the way the person faces
//   noise
//
// Habit, own leans and noise have known spreads. People who face one way leave the slope as
// uncertain as their own leans; people who turn, or face each other, do not. Blocks in which a foot
// is lifted, a leg is bent as by sitting, or the body is nearer to the floor than to upright, are
// ignored.
class BodyEvidence {
 public:
  // Requires feet, hips and poses in the skeleton's joint order.
  void Add(const Skeleton& skeleton, const Clip& person);
  // Absent if nobody stands.
  std::optional<SlopeEstimate> Estimate() const;

 private:
  struct Block {
    std::array<double, 2> lean{};  // towards x and z
    double c = 0, s = 0;           // forward is (s, c) in x and z, left is (c, -s)
    double weight = 1;             // in blocks

    // How slope (x, z) and habit (forward, left), and likewise the own lean, add up to the lean.
    std::array<std::array<double, 4>, 2> Rows() const { return {{{1, 0, s, c}, {0, 1, c, -s}}}; }
  };
  struct Equations;

  static std::optional<Block> BlockOf(const Skeleton& skeleton, const Clip& person, int first,
                                      int end);
  static double Precision(const Block& block, const std::array<double, 4>& now);
  static void AddPerson(const std::vector<Block>& blocks, const std::array<double, 4>& now,
                        Equations* equations);

  std::vector<std::vector<Block>> people_;
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_SLOPE_EVIDENCE_H_
