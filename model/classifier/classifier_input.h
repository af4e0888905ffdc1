#ifndef DUET_MODEL_CLASSIFIER_CLASSIFIER_INPUT_H_
#define DUET_MODEL_CLASSIFIER_CLASSIFIER_INPUT_H_

#include <optional>

#include "model/motion/clip.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"
#include "model/motion/vec3.h"

namespace duet::classifier {

// The people that a classifier sees.
enum class Sees { kFollower, kBoth };

// Number of input vectors per joint.
constexpr int InputParts(Sees sees) { return sees == Sees::kBoth ? 5 : 3; }

// The input of a classifier in each frame, in the standard coordinates of the leader (its root at
// the origin, -z in the direction of the partner, else of its hips). For each joint of the
// follower:
//   1. its position relative to the leader's root (metres);
//   2. its position relative to the follower's own root (metres);
//   3. its velocity in the world (m/s).
// With Sees::kBoth, also for each joint of the leader:
//   4. its position relative to the leader's root (metres);
//   5. its velocity in the world (m/s).
// The second and the third follow from the first, but a network does not learn them from a hundred
// clips: with them, a judge of unseen people has an eighth fewer errors. The coordinates depend
// only on the leader. Shapes: returns [frames, InputParts x joints], all joints of the first part
// first.
motion::Poses ClassifierInput(const motion::Skeleton& skeleton, const motion::ClipPair& pair,
                              const std::optional<motion::Vec3>& partner_direction,
                              Sees sees = Sees::kFollower);

// The horizontal direction from the leader's root to the follower's in the first frame. Nothing if
// they stand at almost the same place.
std::optional<motion::Vec3> DirectionToFollower(const motion::Skeleton& skeleton,
                                                const motion::ClipPair& pair);

}  // namespace duet::classifier

#endif  // DUET_MODEL_CLASSIFIER_CLASSIFIER_INPUT_H_
