#ifndef DUET_MODEL_ENGINE_CROSS_FADE_H_
#define DUET_MODEL_ENGINE_CROSS_FADE_H_

#include <vector>

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

  // Replaces `poses` by a blend that leaves them smoothly and arrives at `next`: even the first
  // frame has some of `next`, even the last some of `poses`.
  // Shapes: poses, next [frames, joints].
  void Blend(motion::Vec3* poses, const motion::Vec3* next, int frames) const;

 private:
  void BlendPose(motion::Vec3* pose, const motion::Vec3* next, float weight) const;

  int joints_;
  int root_;
  std::vector<motion::Bone> bones_;  // parents before their children
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_CROSS_FADE_H_
