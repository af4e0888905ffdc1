#ifndef DUET_TESTS_CLASSIFIER_RANDOM_CLASSIFIER_H_
#define DUET_TESTS_CLASSIFIER_RANDOM_CLASSIFIER_H_

#include "model/classifier/classifier.h"

namespace duet::test {

// A small classifier of "kick" and "hug" for SBU's skeleton at 15 Hz, with random networks and a
// window of 20 frames.
classifier::ClassifierParts RandomClassifier(int networks = 2, int hidden = 4);

}  // namespace duet::test

#endif  // DUET_TESTS_CLASSIFIER_RANDOM_CLASSIFIER_H_
