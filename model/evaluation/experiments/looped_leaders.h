#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_LOOPED_LEADERS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_LOOPED_LEADERS_H_

#include <string>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

// Leaders that formulas make, and captured ones repeated.

namespace duet::evaluation::experiments {

// A leader of model/authoring/made_leaders.h, which is also the id; without a follower.
dataset::Sequence MakeLeaderSequence(const std::string& name, double seconds, double frame_rate_hz);

// Repeats clips of one skeleton for `seconds`. Each clip is rotated and moved on the floor to start
// where the first one starts, and faded in over half a second. Requires clips longer than that.
motion::Poses LoopClips(const motion::Skeleton& skeleton, const std::vector<motion::Poses>& clips,
                        double seconds, double frame_rate_hz);

// Whether a take is long enough for LoopClips.
bool IsLoopable(const dataset::Sequence& take);

// Frames from where a looped take begins to where it begins again. Requires IsLoopable.
int LoopFrames(const dataset::Dataset& dataset, const dataset::Sequence& take);

// The take with its leader looped for `seconds` and its labels repeated. The follower has only its
// first pose. Requires IsLoopable.
dataset::Sequence LoopTake(const dataset::Dataset& dataset, const dataset::Sequence& take,
                           double seconds);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_LOOPED_LEADERS_H_
