#include "model/evaluation/judge/judge_input.h"

namespace duet::evaluation::judge {

motion::Poses JudgeInput(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                         JudgeSees sees) {
  return classifier::ClassifierInput(skeleton, sequence.pair, sequence.partner_direction, sees);
}

}  // namespace duet::evaluation::judge
