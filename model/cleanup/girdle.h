#ifndef DUET_MODEL_CLEANUP_GIRDLE_H_
#define DUET_MODEL_CLEANUP_GIRDLE_H_

#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {

// The directions of the part of a trunk that limbs hang from: orthonormal.
struct Girdle {
  motion::Vec3 left{1, 0, 0}, up{0, 1, 0}, front{0, 0, 1};

  // A direction as the girdle sees it, and back.
  motion::Vec3 Inwards(motion::Vec3 v) const { return {Dot(v, left), Dot(v, up), Dot(v, front)}; }
  motion::Vec3 Outwards(motion::Vec3 v) const { return left * v.x + up * v.y + front * v.z; }
};
using Girdles = std::vector<Girdle>;

// The girdle between two joints in a frame: that of the shoulders or of the hips. That of `before`
// for a trunk without directions, without joints, and for a body without a chest or two legs.
// Shapes: pose [joints].
Girdle GirdleOf(const body::Body& body, const std::optional<motion::JointPair>& joints,
                absl::Span<const motion::Vec3> pose, const Girdle& before = {});

// The girdle between two joints in every frame: that of the shoulders or of the hips. The world's
// axes without joints, and for a body without a chest or two legs. Shapes: returns [frames].
Girdles GirdlesOf(const body::Body& body, const std::optional<motion::JointPair>& joints,
                  const motion::Poses& poses);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_GIRDLE_H_
