#ifndef DUET_MODEL_EVALUATION_METRICS_CLIP_POSES_H_
#define DUET_MODEL_EVALUATION_METRICS_CLIP_POSES_H_

#include "model/motion/clip.h"
#include "model/motion/poses.h"

namespace duet::evaluation::metrics {

// A clip's positions as poses, and back.
inline motion::Poses PosesOf(const motion::Clip& clip) {
  return {clip.joint_count(), clip.positions};
}
inline void SetPoses(const motion::Poses& poses, motion::Clip* clip) {
  clip->positions.assign(poses.all().begin(), poses.all().end());
}

}  // namespace duet::evaluation::metrics

#endif  // DUET_MODEL_EVALUATION_METRICS_CLIP_POSES_H_
