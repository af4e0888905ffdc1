#ifndef DUET_TESTS_FUZZ_CHECKPOINT_TARGETS_H_
#define DUET_TESTS_FUZZ_CHECKPOINT_TARGETS_H_

#include "absl/strings/string_view.h"
#include "tests/fuzz/promises.h"

namespace duet::fuzz {

// Checkpoints. The digests that they carry are fitted to the input first.
Broken Checkpoint(absl::string_view input);  // manifest, NUL, weights
Broken Safetensors(absl::string_view input);

}  // namespace duet::fuzz

#endif  // DUET_TESTS_FUZZ_CHECKPOINT_TARGETS_H_
