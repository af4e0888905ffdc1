#ifndef DUET_MODEL_EVALUATION_JUDGE_JUDGE_INPUT_H_
#define DUET_MODEL_EVALUATION_JUDGE_JUDGE_INPUT_H_

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"

namespace duet::evaluation::judge {

// Values a frame, in triples for each joint, of what a judge sees: JudgeInput's middle dimension.
inline constexpr int kJudgeParts = 3;

// What a judge is shown of a sequence's follower: where each joint is from the leader's root
// (standard frame, metres), where it is about the follower's own root, and its velocity in the
// world (turned to the standard frame, m/s). From a hundred clips a network does not find the
// second and third in the first by itself: with them a judge of unseen people errs an eighth less
// often. Nothing of the follower's own decides the frame. Shapes: returns [frames, kJudgeParts x
// joints].
motion::Poses JudgeInput(const motion::Skeleton& skeleton, const dataset::Sequence& sequence);

}  // namespace duet::evaluation::judge

#endif  // DUET_MODEL_EVALUATION_JUDGE_JUDGE_INPUT_H_
