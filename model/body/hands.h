#ifndef DUET_MODEL_BODY_HANDS_H_
#define DUET_MODEL_BODY_HANDS_H_

#include <optional>

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/motion/vec3.h"

namespace duet::body {

// How far a hand reaches towards a partner: the distance of the hand from its owner's root along
// the floor, in the direction of the partner's root, in lengths of the arm. About 1 for an arm that
// is stretched out to the partner, 0 for one that hangs down. Shapes: pose [joints].
double ReachTowards(const Limb& arm, int root, absl::Span<const motion::Vec3> pose,
                    motion::Vec3 partner_root);

// From this reach on, a leader offers the hand: in captures, two in three such hands are shaken,
// and less than one in ten that reaches half as far.
inline constexpr double kOffersReach = 0.8;

// The distance between the hands of two people where the leader offers one: of all offered hands
// and all hands of the follower, the nearest two. Absent if no hand is offered. Shapes: poses
// [joints].
std::optional<double> OfferedHandDistance(const Body& body, int root,
                                          absl::Span<const motion::Vec3> leader,
                                          absl::Span<const motion::Vec3> follower);

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_HANDS_H_
