#ifndef DUET_MODEL_ENGINE_TURNED_RANGE_H_
#define DUET_MODEL_ENGINE_TURNED_RANGE_H_

#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// How far the hips of a person turn against the line to the partner, from the frame before to this
// one. Degrees, at most half a turn. Requires `frame` >= 1.
double TurnedAt(const motion::JointPair& hips, int root, const motion::Poses& person,
                const motion::Poses& partner, int frame);

// The largest rotation in each direction, with or without pauses and small rotations back. Degrees.
class TurnedRange {
 public:
  // Adds how far the person turns in the next frame.
  void Add(double degrees);

  double forwards() const { return forwards_; }
  double backwards() const { return backwards_; }
  double farthest() const { return forwards_ > backwards_ ? forwards_ : backwards_; }

 private:
  double at_ = 0, lowest_ = 0, highest_ = 0, forwards_ = 0, backwards_ = 0;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_TURNED_RANGE_H_
