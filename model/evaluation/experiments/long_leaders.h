#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_LONG_LEADERS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_LONG_LEADERS_H_

#include <string>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// Leaders that last, to see whether a follower stays on its feet: made by formulas, unlike anything
// in the captures, and captured clips one after the other.
//
// Units: metres, y up, the floor at y = 0 for those made; frames a second.

namespace duet::evaluation::experiments {

// idle (stands and sways), walk_eight, dance, sit (sits down and gets up).
const std::vector<std::string>& MadeLeaderNames();

// A person of SbuSkeleton's joints with limbs of constant lengths, who starts facing -z near the
// origin; standing feet stay where they are. Requires one of MadeLeaderNames.
motion::Poses MakeLeader(const std::string& name, double seconds, double frame_rate_hz);

// Clips of one skeleton over and over, until `seconds` are full. Each is turned and moved on the
// floor to start where the first one starts, and faded in over half a second. Requires clips longer
// than that.
motion::Poses LoopClips(const motion::Skeleton& skeleton, const std::vector<motion::Poses>& clips,
                        double seconds, double frame_rate_hz);

// A leader that lasts, by name, with the follower's first pose alone for an answer.
struct LongLeader {
  std::string name;
  dataset::Sequence sequence;
};

// Those made, each with a standing follower a metre in front; and, as "captured", the class's clips
// among `sequences` looped, of which at least one must be long enough for LoopClips. The data's
// skeleton must have SbuSkeleton's joints for those made, or they are left out.
std::vector<LongLeader> MakeLongLeaders(const dataset::Dataset& dataset,
                                        const std::vector<int>& sequences, int interaction_class,
                                        double seconds);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_LONG_LEADERS_H_
