#ifndef DUET_MODEL_BODY_CONTACT_H_
#define DUET_MODEL_BODY_CONTACT_H_

#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "model/body/limbs.h"
#include "model/motion/body_part.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

// How two bodies come together: hands that reach for a partner, overlap and touch.

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

// How deeply two bodies overlap. A frame's depth is the largest max(0, r1 + r2 - d) over all pairs
// of a leader's and a follower's bone, with radii r1 and r2 at a distance d. Less is not always
// better, since people touch when they hug: compare it with that of the captured pair.
// Shapes: leader and follower are alike, in world metres.
struct Penetration {
  double frequency = 0;          // share of frames with a depth above 0
  double mean_depth_metres = 0;  // over those frames; 0 without any
  double max_depth_metres = 0;
};
Penetration MeasurePenetration(const motion::Poses& leader, const motion::Poses& follower,
                               const motion::Skeleton& skeleton,
                               const std::vector<motion::BodyPart>& parts);

// The ends of the limbs: the last joints of bone chains in parts with "arm" or "leg" in their name.
// In an SBU skeleton, hands and feet.
std::vector<int> LimbEnds(const motion::Skeleton& skeleton,
                          const std::vector<motion::BodyPart>& parts);

// The share of frames in which a hand or a foot of the follower touches the leader: is within 5 cm
// of the capsule around one of the leader's bones (CapsuleRadii). NaN without limb ends.
// Shapes: leader and follower are alike, in world metres.
double TouchShare(const motion::Poses& leader, const motion::Poses& follower,
                  const motion::Skeleton& skeleton, const std::vector<motion::BodyPart>& parts);

}  // namespace duet::body

#endif  // DUET_MODEL_BODY_CONTACT_H_
