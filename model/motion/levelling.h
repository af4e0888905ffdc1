#ifndef DUET_MODEL_MOTION_LEVELLING_H_
#define DUET_MODEL_MOTION_LEVELLING_H_

#include "model/motion/poses.h"
#include "model/motion/vec3.h"

namespace duet::motion {

// Transforms the world as a tilted camera captured it to a level one: the shortest rotation, which
// is about a horizontal axis, takes the vertical to +y, and the floor moves to y = 0. A
// default-constructed Levelling is the exact identity.
//
// Units: metres, y up.
class Levelling {
 public:
  Levelling() = default;
  // `up` is the captured vertical, of any length, less than 90 degrees from +y. `floor_height` is
  // the height of the floor after the rotation.
  Levelling(Vec3 up, float floor_height);

  // Apply converts captured to level; Invert is its inverse, exact up to rounding.
  Vec3 Apply(Vec3 captured) const;
  Vec3 Invert(Vec3 level) const;
  Poses Apply(Poses captured) const;
  Poses Invert(Poses level) const;

  Vec3 up() const { return up_; }
  float floor_height() const { return floor_height_; }

 private:
  // The rows of the rotation; up_ is the second.
  Vec3 row_x_ = {1, 0, 0};
  Vec3 up_ = {0, 1, 0};
  Vec3 row_z_ = {0, 0, 1};
  float floor_height_ = 0;
};

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_LEVELLING_H_
