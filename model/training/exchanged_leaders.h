#ifndef DUET_MODEL_TRAINING_EXCHANGED_LEADERS_H_
#define DUET_MODEL_TRAINING_EXCHANGED_LEADERS_H_

#include <vector>

#include "model/base/random.h"
#include "model/dataset/dataset.h"

namespace duet::training {

// Captured labels say nothing that the leader's motion does not say, so a network can ignore them.
// For a fraction `share` of the sequences, the leader is replaced by that of another sequence with
// other labels. The follower and its labels stay: only the labels tell what the follower does.
// Sequences without a partner of at least their length and other labels keep their leader.
void ExchangeLeaders(const motion::Skeleton& skeleton, double share, base::Random* random,
                     std::vector<dataset::Sequence>* sequences);

// The sequence with the leader of `other`. The follower begins as it does before its own leader and
// keeps its distance from the leader's path; it does not follow its turns. Requires `other` to have
// at least as many frames.
dataset::Sequence WithLeaderOf(const motion::Skeleton& skeleton, const dataset::Sequence& other,
                               dataset::Sequence sequence);

// The share of the frames of `a` in which `a` and `b` have the same classes.
double EqualLabels(const dataset::Sequence& a, const dataset::Sequence& b);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_EXCHANGED_LEADERS_H_
