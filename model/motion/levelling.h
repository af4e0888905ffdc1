#ifndef DUET_MODEL_MOTION_LEVELLING_H_
#define DUET_MODEL_MOTION_LEVELLING_H_

#include "model/motion/poses.h"
#include "model/motion/vec3.h"

namespace duet::motion {

// From the world as a tilted camera captured it to a level one: the vertical becomes +y by the
// shortest turn, which is about a horizontal axis, and the floor comes to y = 0. A default one
// changes nothing, not even a last digit.
//
// Units: metres, y up.
class Levelling {
 public:
  Levelling() = default;
  // `up` is the vertical as captured, of any length, less than 90 degrees from +y; `floor_height`
  // is where the floor is after the turn.
  Levelling(Vec3 up, float floor_height);

  // Captured to level; and back, the exact inverse up to rounding.
  Vec3 Apply(Vec3 captured) const;
  Vec3 Invert(Vec3 level) const;
  Poses Apply(Poses captured) const;
  Poses Invert(Poses level) const;

  Vec3 up() const { return up_; }
  float floor_height() const { return floor_height_; }

 private:
  // The rows of the turn.
  Vec3 row_x_ = {1, 0, 0};
  Vec3 up_ = {0, 1, 0};
  Vec3 row_z_ = {0, 0, 1};
  float floor_height_ = 0;
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_LEVELLING_H_
