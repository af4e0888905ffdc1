#ifndef DUET_MODEL_EVALUATION_JUDGE_JUDGE_INPUT_H_
#define DUET_MODEL_EVALUATION_JUDGE_JUDGE_INPUT_H_

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"

namespace duet::evaluation::judge {

// Whom a judge is shown.
enum class JudgeSees { kFollower, kBoth };

// What a judge is shown of each joint: so many vectors.
constexpr int JudgeParts(JudgeSees sees) { return sees == JudgeSees::kBoth ? 5 : 3; }

// What a judge is shown of a sequence's follower in each frame, in the standard coordinates of the
// leader:
//   1. where each joint is, seen from the leader's root (metres);
//   2. where it is, seen from the follower's own root (metres);
//   3. its velocity in the world (m/s).
// and, of JudgeSees::kBoth, of the leader's joints:
//   4. where each is, seen from the leader's root (metres);
//   5. its velocity in the world (m/s).
// The second and the third follow from the first, but a network that learns from a hundred clips
// does not find them: with them a judge of unseen people errs an eighth less often. The leader
// alone decides the frame.
// Shapes: returns [frames, JudgeParts x joints], all joints of the first part first.
motion::Poses JudgeInput(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                         JudgeSees sees = JudgeSees::kFollower);

}  // namespace duet::evaluation::judge

#endif  // DUET_MODEL_EVALUATION_JUDGE_JUDGE_INPUT_H_
