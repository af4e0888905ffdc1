#ifndef DUET_MODEL_EVALUATION_JUDGE_JUDGE_INPUT_H_
#define DUET_MODEL_EVALUATION_JUDGE_JUDGE_INPUT_H_

#include "model/classifier/classifier_input.h"
#include "model/dataset/dataset.h"
#include "model/motion/poses.h"

namespace duet::evaluation::judge {

// The people that a judge sees.
using JudgeSees = classifier::Sees;

// The number of vectors per joint in a judge's input.
constexpr int JudgeParts(JudgeSees sees) { return classifier::InputParts(sees); }

// A judge's input for a sequence's follower in each frame: ClassifierInput in the sequence's own
// direction. Shapes: returns [frames, JudgeParts x joints].
motion::Poses JudgeInput(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                         JudgeSees sees = JudgeSees::kFollower);

}  // namespace duet::evaluation::judge

#endif  // DUET_MODEL_EVALUATION_JUDGE_JUDGE_INPUT_H_
