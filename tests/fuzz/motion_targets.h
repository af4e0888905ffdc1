#ifndef DUET_TESTS_FUZZ_MOTION_TARGETS_H_
#define DUET_TESTS_FUZZ_MOTION_TARGETS_H_

#include "absl/strings/string_view.h"
#include "tests/fuzz/promises.h"

namespace duet::fuzz {

// Files of motion, and what describes them.
Broken Bvh(absl::string_view input);
Broken Csv(absl::string_view input);
Broken Gltf(absl::string_view input);
Broken JsonMotion(absl::string_view input);
Broken Npy(absl::string_view input);
Broken SbuText(absl::string_view input);
Broken JointMap(absl::string_view input);
Broken DatasetLayout(absl::string_view input);
Broken DatasetIndex(absl::string_view input);

}  // namespace duet::fuzz

#endif  // DUET_TESTS_FUZZ_MOTION_TARGETS_H_
