#ifndef DUET_MODEL_SOLVER_PINS_H_
#define DUET_MODEL_SOLVER_PINS_H_

#include "model/body/limbs.h"
#include "model/motion/pin.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::solver {

// Moves joints of a follower to their pins by smooth corrections, which are 0 in the given frames:
// pins in them have no effect. A joint that cannot get to its pin gets as close as it can.
//
// Hands, feet, elbows and knees move by their limb, every other joint by the whole body.
class PinnedBody {
 public:
  // `skeleton` and `body` outlive this. Requires pins of the skeleton's joints. `follower`: the
  // motion from which the softness of pins counts.
  PinnedBody(const motion::Skeleton& skeleton, const body::Body& body, const motion::Pins& pins,
             double frame_rate_hz, int given, const motion::Poses& follower);

  // Before the feet are planned: moves the whole body to its pins, and to where its limbs reach
  // theirs.
  void Approach(motion::Poses* follower) const;
  // Afterwards: moves the body above its feet, and the limbs.
  void Place(motion::Poses* follower) const;

 private:
  struct LimbPins {
    const body::Limb* limb = nullptr;
    bool is_leg = false;
    motion::Pins pins;
  };
  // Corrections that take the joints of `pins` to them. Shapes: returns [frames].
  std::vector<motion::Vec3> Track(const motion::Pins& pins, double seconds,
                                  const motion::Poses& follower) const;
  std::vector<motion::Vec3> Track(const motion::Pins& pins, const std::vector<motion::Vec3>& ways,
                                  double seconds, int frames) const;
  // The pins, nearer where there is no time to get to them.
  motion::Pins InTimeOf(motion::Pins pins, double fastest, const motion::Poses& follower) const;
  void MoveJoint(const LimbPins& pinned, int joint, motion::Vec3 way,
                 absl::Span<motion::Vec3> pose) const;

  const motion::Skeleton& skeleton_;
  const body::Body& body_;
  double frame_rate_hz_;
  int given_;
  motion::Pins body_pins_;
  std::vector<LimbPins> limbs_;
};

// Returns the mean distance between the pins and their joints in the frames of `follower` from
// `given` on, metres; 0 if there are none.
double MeanPinDistance(const motion::Pins& pins, const motion::Poses& follower, int given);

}  // namespace duet::solver

#endif  // DUET_MODEL_SOLVER_PINS_H_
