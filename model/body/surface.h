#ifndef DUET_MODEL_BODY_SURFACE_H_
#define DUET_MODEL_BODY_SURFACE_H_

#include <vector>

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::body {

// The surface of a body without its arms, as capsules around its bones. World metres.
//
// Threads: const methods are safe to call concurrently.
class Surface {
 public:
  Surface(const motion::Skeleton& skeleton, const Body& body);

  // How far a point is from the surface; negative inside. Shapes: pose [joints].
  double Distance(motion::Vec3 point, absl::Span<const motion::Vec3> pose) const;

 private:
  struct Bone {
    motion::Bone joints;
    double radius = 0;
  };
  std::vector<Bone> bones_;
};

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_SURFACE_H_
