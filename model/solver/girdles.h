#ifndef DUET_MODEL_SOLVER_GIRDLES_H_
#define DUET_MODEL_SOLVER_GIRDLES_H_

#include <array>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::solver {

// The distances of the two hips and of the two shoulders. 0 if a skeleton lacks them, or if they do
// not hang from the same joint. Unit: metres.
struct GirdleWidths {
  float hips = 0;
  float shoulders = 0;
};

// Keeps pelvis and shoulders rigid. Bones of constant lengths do not: the two bones to the hips can
// fold up like scissors.
class Girdles {
 public:
  // Requires a skeleton that Validate accepts.
  explicit Girdles(const motion::Skeleton& skeleton);

  // The median widths over all frames. Requires at least one frame.
  GirdleWidths Measure(const motion::Poses& person) const;

  // Gives both girdles their widths, as far as their bones reach. Bones keep their lengths. Limbs
  // move along and keep their bend; or, for the second, hands and feet stay where they are, as far
  // as the limbs reach. Shapes: pose [joints].
  void Apply(const GirdleWidths& widths, absl::Span<motion::Vec3> pose) const;
  void ApplyAboveFeet(const GirdleWidths& widths, absl::Span<motion::Vec3> pose) const;

 private:
  // Two limbs that hang from one joint.
  struct Girdle {
    int middle = 0;
    std::array<body::Limb, 2> limbs;  // left and right
    bool bends_forwards = true;       // legs do, arms do not
  };
  static std::optional<Girdle> Find(const motion::Skeleton& skeleton,
                                    const std::vector<body::Limb>& limbs, bool bends_forwards);
  static float Width(const std::optional<Girdle>& girdle, const motion::Poses& person);
  static void Spread(const Girdle& girdle, float width, motion::Vec3 trunk, bool ends_stay,
                     absl::Span<motion::Vec3> pose);
  void Spread(const GirdleWidths& widths, bool ends_stay, absl::Span<motion::Vec3> pose) const;

  std::optional<Girdle> hips_, shoulders_;
};

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_GIRDLES_H_
