#ifndef DUET_MODEL_CLEANUP_UPRIGHT_H_
#define DUET_MODEL_CLEANUP_UPRIGHT_H_

#include <vector>

#include "model/cleanup/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {

struct UprightOptions {
  bool enabled = true;
  // A lean up to the first angle is left alone; none that lasts goes beyond the second.
  double free_degrees = 8;
  double most_degrees = 11;
  // A lean lasts when it outlives a Gaussian of this deviation: a bow or a kick does not.
  double sigma_seconds = 0.35;
};

// Where the body points in every frame, for longer than a moment: from the middle of a pair of
// joints, feet or hips, to the chest, of length 1. Shapes: returns [frames].
std::vector<motion::Vec3> LastingLean(const motion::JointPair& base, int chest,
                                      const motion::Poses& poses, double sigma_frames);

// Bends a trunk that leans for longer than a moment back towards upright at the hips; feet stay
// where they are, knees follow. A skeleton without hips or legs stays as it is.
void SetTrunkUpright(const motion::Skeleton& skeleton, const Body& body,
                     const UprightOptions& options, const Timing& timing, motion::Poses* poses);

// Turns a body that leans for longer than a moment back towards upright, whichever way it leans,
// about the point between its feet. A skeleton without hips or feet stays as it is.
void SetUpright(const motion::Skeleton& skeleton, const Body& body, const UprightOptions& options,
                const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_UPRIGHT_H_
