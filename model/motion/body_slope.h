#ifndef DUET_MODEL_MOTION_BODY_SLOPE_H_
#define DUET_MODEL_MOTION_BODY_SLOPE_H_

#include <array>
#include <optional>
#include <vector>

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/motion/slope.h"

namespace duet::motion {

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

#endif  // DUET_MODEL_MOTION_BODY_SLOPE_H_
