#ifndef DUET_MODEL_ENGINE_CROSS_FADE_H_
#define DUET_MODEL_ENGINE_CROSS_FADE_H_

#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::engine {

// Blends one motion into another over the frames that they share, preserving limb lengths.
//
// Averaging two poses joint by joint shortens every limb whose direction differs between them.
// Therefore only the root is averaged, and each bone gets the average direction and length.
class CrossFade {
 public:
  // Requires a skeleton that Validate accepts.
  explicit CrossFade(const motion::Skeleton& skeleton);

  // Replaces the frames of `poses` from `first` on by a smooth blend from `poses` to `next`, whose
  // frame 0 corresponds to `first`. The first blended frame contains some of `next`, the last some
  // of `poses`. Requires `next` to have at least as many frames.
  void Blend(const motion::Poses& next, int first, motion::Poses* poses) const;

 private:
  void BlendPose(absl::Span<const motion::Vec3> next, float weight,
                 absl::Span<motion::Vec3> pose) const;

  std::size_t root_;
  std::vector<motion::Bone> bones_;  // parents before their children
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_CROSS_FADE_H_
