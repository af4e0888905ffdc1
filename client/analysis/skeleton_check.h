#ifndef DUET_CLIENT_ANALYSIS_SKELETON_CHECK_H_
#define DUET_CLIENT_ANALYSIS_SKELETON_CHECK_H_

#include <map>
#include <string>
#include <vector>

#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::analysis {

// One thing that was looked at.
struct Check {
  std::string name;  // "limb lengths"
  bool good = true;
  std::string text;                       // what was found, for people
  std::map<std::string, double> figures;  // the same for programs, units in the names
};

// Whether a motion is that of a person, in this order: finite (no position is infinite or no
// number), size (from foot to root as a person's), limb lengths (hardly change over time), symmetry
// (left limbs as long as right ones), floor (feet stay on it), jumps (no joint is faster than
// people are), sides (left and right are not swapped), upright (the mean standing direction leans
// no more than people do), waist (shoulders hardly turn against the hips). A check that needs
// joints the skeleton lacks is left out; after a position that is not finite only the first is
// there.
//
// What is not good is worth a look, and may be right: Kinect's bones grow and shrink, acrobats
// leave the floor.
//
// Requires a frame, the skeleton's joints, and a skeleton that Validate accepts. Where the rate is
// 0 (not known), jumps are left out.
std::vector<Check> CheckSkeleton(const motion::Clip& clip, const motion::Skeleton& skeleton);

}  // namespace duet::client::analysis

#endif  // DUET_CLIENT_ANALYSIS_SKELETON_CHECK_H_
