#ifndef DUET_MODEL_CLEANUP_PAIR_LINE_H_
#define DUET_MODEL_CLEANUP_PAIR_LINE_H_

#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

// The line between two joints that belong together, such as both hips: how it lies across the
// trunk, and where its joints are for a line that is wanted.
namespace duet::cleanup {

// The directions of a trunk: orthonormal.
struct TrunkAxes {
  motion::Vec3 down;    // from the chest to the middle of the hips
  motion::Vec3 left;    // of the body
  motion::Vec3 behind;  // such that a positive angle from left towards it is a turn to the left
};

// A line in these axes, from its right joint to its left one.
struct PairLine {
  float turn = 0;   // degrees from `left`, to the left; -90 to 90 with mirrored ones
  float tilt = 0;   // degrees downwards on the left
  float width = 0;  // metres
  bool reversed = false;
};
// Requires a line of some length.
PairLine Describe(const TrunkAxes& axes, motion::Vec3 across);

struct PlacedPair {
  motion::Vec3 left, right;
};
// Both joints on a line, at their distances `to_left` and `to_right` from their parent at `from`,
// in the direction `towards`.
PlacedPair PlacePair(const TrunkAxes& axes, const PairLine& line, motion::Vec3 from,
                     motion::Vec3 towards, float to_left, float to_right);

// The median distance of two joints in the first frames. Requires at least one frame.
float MedianWidth(const motion::JointPair& pair, const motion::Poses& poses, int frames);

// A signed angle within a soft range around 0.
float Within(const SoftRange& range, float degrees);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_PAIR_LINE_H_
