#ifndef DUET_MODEL_BODY_LIMBS_H_
#define DUET_MODEL_BODY_LIMBS_H_

#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/body_part.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::body {

// An arm or a leg: a chain of two bones, and the joints beyond their end (toes, fingers).
struct Limb {
  int upper = 0;   // hip, shoulder
  int middle = 0;  // knee, elbow
  int end = 0;     // foot, hand
  std::vector<int> beyond;
};

// The neck.
struct Neck {
  int base = 0;             // the joint to which the head is attached
  int head = 0;             // the first joint with "head" in its name
  std::vector<int> branch;  // the head and all beyond it
};

// The limbs of a body, derived from its skeleton's tree.
struct Body {
  // Where the arms meet the spine: of the joints with at least three bones that are not on a leg,
  // the one nearest to the pelvis. Absent without hips.
  std::optional<int> chest;
  std::vector<Limb> legs;  // left and right; none if a foot is attached by fewer than two bones
  // Chains of at least three joints from the chest to a joint with "wrist" in its name, or else to
  // their last joint; without the head's.
  std::vector<Limb> arms;
  // Where the arms begin. Absent unless there are two arms and the names of their joints contain
  // "left" and "right".
  std::optional<motion::JointPair> shoulders;
  std::optional<Neck> neck;
};
// Requires a skeleton that Validate accepts.
Body FindBody(const motion::Skeleton& skeleton);

// Returns arms and legs as parts, in the body's order. They determine the radii of capsules.
std::vector<motion::BodyPart> LimbParts(const Body& body);

// Moves a limb's end to `target`, or as close as the limb reaches, by rotating its two bones. The
// middle joint stays on its side; a limb that is nearly straight bends towards `forward`. Preserves
// bone lengths. Shapes: pose [joints].
void Reach(const Limb& limb, motion::Vec3 target, motion::Vec3 forward,
           absl::Span<motion::Vec3> pose);

// The same, with the middle joint on the side of `bend`: a direction that need not be perpendicular
// to the limb.
void ReachBent(const Limb& limb, motion::Vec3 target, motion::Vec3 bend,
               absl::Span<motion::Vec3> pose);

// Returns the length of both bones of a limb. Shapes: pose [joints].
float LengthOf(const Limb& limb, absl::Span<const motion::Vec3> pose);

// Returns the offset of a limb's middle joint from the line between its ends. Near zero for a limb
// that is nearly straight. Shapes: pose [joints].
motion::Vec3 BendOf(const Limb& limb, absl::Span<const motion::Vec3> pose);

// Returns the direction in which the hips face: horizontal, of length 1. Shapes: pose [joints].
motion::Vec3 Facing(const motion::JointPair& hips, absl::Span<const motion::Vec3> pose);

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_LIMBS_H_
