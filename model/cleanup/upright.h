#ifndef DUET_MODEL_CLEANUP_UPRIGHT_H_
#define DUET_MODEL_CLEANUP_UPRIGHT_H_

#include <vector>

#include "model/body/limbs.h"
#include "model/cleanup/timing.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {

struct UprightOptions {
  bool enabled = true;
  // Lasting leans up to the first angle are not corrected. After correction, none exceeds the
  // second.
  double free_degrees = 8;
  double most_degrees = 11;
  // Standard deviation of the Gaussian that separates lasting leans from short ones, such as a bow
  // or a kick.
  double sigma_seconds = 0.35;
};

// Returns the smoothed direction of the body in every frame: from the middle of a pair of joints
// (feet or hips) to the chest, of length 1. Shapes: returns [frames].
std::vector<motion::Vec3> LastingLean(const motion::JointPair& base, int chest,
                                      const motion::Poses& poses, double sigma_frames);

// Rotates a trunk with a lasting lean towards upright about the hips. The feet keep their
// positions, and the knees follow. Does nothing for a skeleton without hips or legs.
void SetTrunkUpright(const motion::Skeleton& skeleton, const body::Body& body,
                     const UprightOptions& options, const Timing& timing, motion::Poses* poses);

// Rotates a body with a lasting lean in any direction towards upright about the point between its
// feet. Does nothing for a skeleton without hips or feet.
void SetUpright(const motion::Skeleton& skeleton, const body::Body& body,
                const UprightOptions& options, const Timing& timing, motion::Poses* poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_UPRIGHT_H_
