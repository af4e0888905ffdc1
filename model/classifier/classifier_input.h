#ifndef DUET_MODEL_CLASSIFIER_CLASSIFIER_INPUT_H_
#define DUET_MODEL_CLASSIFIER_CLASSIFIER_INPUT_H_

#include <optional>

#include "model/motion/clip.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::classifier {

// Whom a classifier is shown.
enum class Sees { kFollower, kBoth };

// What it is shown of each joint: so many vectors.
constexpr int InputParts(Sees sees) { return sees == Sees::kBoth ? 5 : 3; }

// What a classifier is shown of a follower in each frame, in the standard coordinates of the leader
// (its root at the origin, -z in the direction of the partner, or where its hips face):
//   1. where each joint is, seen from the leader's root (metres);
//   2. where it is, seen from the follower's own root (metres);
//   3. its velocity in the world (m/s).
// and, of Sees::kBoth, of the leader's joints:
//   4. where each is, seen from the leader's root (metres);
//   5. its velocity in the world (m/s).
// The second and the third follow from the first, but a network that learns from a hundred clips
// does not find them: with them a judge of unseen people errs an eighth less often. The leader
// alone decides the frame.
// Shapes: returns [frames, InputParts x joints], all joints of the first part first.
motion::Poses ClassifierInput(const motion::Skeleton& skeleton, const motion::ClipPair& pair,
                              const std::optional<motion::Vec3>& partner_direction,
                              Sees sees = Sees::kFollower);

// The horizontal direction from the leader's root to the follower's in the first frame; nothing
// where they stand as good as on one spot.
std::optional<motion::Vec3> DirectionToFollower(const motion::Skeleton& skeleton,
                                                const motion::ClipPair& pair);

}  // namespace duet::classifier

#endif  // DUET_MODEL_CLASSIFIER_CLASSIFIER_INPUT_H_
