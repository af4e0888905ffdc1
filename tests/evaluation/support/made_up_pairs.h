#ifndef DUET_TESTS_EVALUATION_SUPPORT_MADE_UP_PAIRS_H_
#define DUET_TESTS_EVALUATION_SUPPORT_MADE_UP_PAIRS_H_

#include "model/dataset/dataset.h"

namespace duet::test {

// Pairs of SBU figures whose follower answers the leader exactly, so that a method that learns at
// all does better than a pose held still. The leader raises its right hand by an amount of the
// sequence's own. Class "give": the follower, 1.2 m in front, raises its hand as far and steps back
// by half of it. Class "flinch": it lowers its hand and steps back by twice of it. Each sequence
// stands and faces elsewhere in the world. Subjects a, b, c, ... in turn.
dataset::Dataset MadeUpPairs(int sequences_a_class);

}  // namespace duet::test

#endif  // DUET_TESTS_EVALUATION_SUPPORT_MADE_UP_PAIRS_H_
