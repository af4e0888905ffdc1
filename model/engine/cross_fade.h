#ifndef DUET_MODEL_ENGINE_CROSS_FADE_H_
#define DUET_MODEL_ENGINE_CROSS_FADE_H_

#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::engine {

// Turns one motion into another over the frames that they share, keeping limb lengths.
//
// Averaging two poses joint by joint shortens every limb that points elsewhere in the other one. So
// only the root is averaged; each bone gets the averaged direction and the averaged length.
class CrossFade {
 public:
  // Requires a skeleton that Validate accepts.
  explicit CrossFade(const motion::Skeleton& skeleton);

  // Replaces the frames of `poses` from `first` on by a blend that leaves them smoothly and arrives
  // at `next`, whose frame 0 belongs to `first`: even the first of them has some of `next`, even
  // the last some of `poses`. `next` has at least as many frames.
  void Blend(const motion::Poses& next, int first, motion::Poses* poses) const;

 private:
  void BlendPose(absl::Span<const motion::Vec3> next, float weight,
                 absl::Span<motion::Vec3> pose) const;

  std::size_t root_;
  std::vector<motion::Bone> bones_;  // parents before their children
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_CROSS_FADE_H_
