#ifndef DUET_CLIENT_CLI_SKELETON_CHECK_H_
#define DUET_CLIENT_CLI_SKELETON_CHECK_H_

#include <string>
#include <vector>

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {

// The result of one check.
struct SkeletonCheck {
  std::string name;  // "limb lengths"
  bool good = true;
  std::string text;  // the finding
};

// Checks whether a motion can be that of a person, in this order: finite (no position is infinite
// or NaN), size (the distance from foot to root), limb lengths (nearly constant over time), floor
// (feet stay on it), jumps (no joint is faster than people), sides (left and right are not
// swapped). Checks that need joints which the skeleton does not have are left out. If a position is
// not finite, only the first check is returned.
//
// A check that is not good marks something to look at, not an error: Kinect's bones change their
// length, and acrobats leave the floor.
//
// Requires at least one frame, the skeleton's joints, and a skeleton that Validate accepts. If the
// rate is 0 (unknown), jumps are not checked.
std::vector<SkeletonCheck> CheckSkeleton(const motion::Clip& clip,
                                         const motion::Skeleton& skeleton);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_SKELETON_CHECK_H_
