#ifndef DUET_TESTS_FUZZ_MOTION_TARGETS_H_
#define DUET_TESTS_FUZZ_MOTION_TARGETS_H_

#include "absl/strings/string_view.h"
#include "tests/fuzz/promises.h"

namespace duet::fuzz {

// Files of motion, and what describes them.
Broken Bvh(absl::string_view input);
Broken Csv(absl::string_view input);
Broken Fbx(absl::string_view input);
Broken Gltf(absl::string_view input);
Broken JsonEvents(absl::string_view input);  // base::ReadJsonEvents beside nlohmann::json
Broken JsonMotion(absl::string_view input);
Broken Npy(absl::string_view input);
Broken ResearchNpy(absl::string_view input);  // a byte that chooses the layout, then the array
Broken SmplNpz(absl::string_view input);      // an archive that is both motion and body model
Broken SbuText(absl::string_view input);
Broken AsfAmc(absl::string_view input);  // skeleton, NUL, motion
Broken Keyframes(absl::string_view input);
Broken JointMap(absl::string_view input);
Broken DatasetLayout(absl::string_view input);
Broken DatasetIndex(absl::string_view input);

}  // namespace duet::fuzz

#endif  // DUET_TESTS_FUZZ_MOTION_TARGETS_H_
