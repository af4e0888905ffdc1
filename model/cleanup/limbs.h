#ifndef DUET_MODEL_CLEANUP_LIMBS_H_
#define DUET_MODEL_CLEANUP_LIMBS_H_

#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/body_part.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {

// An arm or a leg: two bones in a row, and what hangs on their end (toes, fingers).
struct Limb {
  int upper = 0;   // hip, shoulder
  int middle = 0;  // knee, elbow
  int end = 0;     // foot, hand
  std::vector<int> beyond;
};

// What carries the head.
struct Neck {
  int base = 0;             // the joint that the head hangs on
  int head = 0;             // the first joint with "head" in its name
  std::vector<int> branch;  // the head and all beyond it
};

// What a skeleton's tree tells of a body. Requires a skeleton that Validate accepts.
struct Body {
  // Where the arms meet the spine: the joint of three bones or more that is nearest to the pelvis,
  // off the legs. Absent without hips.
  std::optional<int> chest;
  std::vector<Limb> legs;  // left and right, or none where a foot hangs on fewer than two bones
  std::vector<Limb> arms;  // chains of three joints or more from the chest, but for the head's
  std::optional<Neck> neck;
};
Body FindBody(const motion::Skeleton& skeleton);

// Arms and legs as parts, in the body's order: what capsules have their radii from.
std::vector<motion::BodyPart> LimbParts(const Body& body);

// The radius of every bone's capsule, metres; see motion::CapsuleRadii. Shapes: returns [bones].
std::vector<double> CapsuleRadii(const motion::Skeleton& skeleton, const Body& body);

// Moves a limb's end to `target`, or as near as the limb reaches, by turning its two bones. The
// middle joint keeps to its side; a limb that is nearly straight bends towards `forward` instead.
// Bones keep their lengths. Shapes: pose [joints].
void Reach(const Limb& limb, motion::Vec3 target, motion::Vec3 forward,
           absl::Span<motion::Vec3> pose);

// Where the hips of a pose face: horizontal, of length 1. Requires hips. Shapes: pose [joints].
motion::Vec3 Facing(const motion::JointPair& hips, absl::Span<const motion::Vec3> pose);

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_LIMBS_H_
