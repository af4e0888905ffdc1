#ifndef DUET_MODEL_MOTION_VERTICAL_H_
#define DUET_MODEL_MOTION_VERTICAL_H_

#include <string>
#include <utility>

#include "absl/strings/string_view.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"
#include "model/motion/slope_evidence.h"
#include "model/motion/vec3.h"

// Estimates the true vertical of a capture, which a tilted camera rotates, from the people in it.
//
// Two kinds of evidence, each with its standard error (docs/decisions/captures.md):
//
//   floor   A plane through the places where feet rest (FloorEvidence). Feet that rest in one place
//           or on one line do not define it.
//   bodies  The directions in which people stand (BodyEvidence). A camera's tilt is the same
//           whichever way a person faces; a person's own lean turns with the person. People who
//           face one way do not tell the two apart.
//
// Units: metres, y up, degrees.

namespace duet::motion {

enum class TiltVerdict {
  kLevel,   // +y is the vertical, as far as the answers of a model are concerned
  kTilted,  // `up` is the vertical
  kUnknown  // a tilted camera and people who lean, or a sloping floor, look the same here
};

// "level", "tilted" or "unknown".
absl::string_view VerdictName(TiltVerdict verdict);

struct VerticalEstimate {
  TiltVerdict verdict = TiltVerdict::kUnknown;
  // The most likely vertical, of length 1. Only kTilted is strong enough to rely on it.
  Vec3 up = {0, 1, 0};
  double tilt_degrees = 0;   // of `up` from +y
  double error_degrees = 0;  // standard error of `up` in the direction in which it is least certain
  double deviations = 0;     // the tilt, divided by its standard error
  // The angle between the verticals of floor and bodies, divided by its standard error. 0 if one of
  // the two is absent.
  double disagreement = 0;
  int places = 0;  // where feet rest
};

// Collects people that one camera captured in one position, and estimates their vertical.
class VerticalEvidence {
 public:
  explicit VerticalEvidence(Skeleton skeleton) : skeleton_(std::move(skeleton)) {}

  // Poses: in the skeleton's joint order. Keeps about 100 bytes for each second. A person without
  // feet is no evidence.
  void Add(const Clip& person);
  VerticalEstimate Estimate() const;

 private:
  Skeleton skeleton_;
  FloorEvidence floor_;
  BodyEvidence bodies_;
};

// The verdict in one line, such as "tilted by 10.2 degrees (0.3 towards x, 10.2 towards z;
// +- 1.4)".
std::string Describe(const VerticalEstimate& estimate);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_VERTICAL_H_
