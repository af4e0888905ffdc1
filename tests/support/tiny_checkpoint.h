#ifndef DUET_TESTS_SUPPORT_TINY_CHECKPOINT_H_
#define DUET_TESTS_SUPPORT_TINY_CHECKPOINT_H_

#include "model/checkpoint/checkpoint.h"
#include "model/checkpoint/manifest.h"

namespace duet::test {

// The smallest manifest with every kind of content: three joints in two parts, two classes, two
// hidden units. Its weights are not filled in.
checkpoint::Manifest TinyManifest();

// The same with the size and the hash of some weights, so that its text can be read again.
checkpoint::Manifest CompleteManifest();

// A checkpoint with weights by a rule that any language can repeat: value i of tensor k (in the
// order of ExpectedTensors) is ((31 k + 7 i) mod 17 - 8) / 16.
checkpoint::Checkpoint FilledCheckpoint(checkpoint::Manifest manifest);

inline checkpoint::Checkpoint TinyCheckpoint() { return FilledCheckpoint(TinyManifest()); }

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_TINY_CHECKPOINT_H_
