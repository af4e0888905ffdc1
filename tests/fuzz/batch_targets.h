#ifndef DUET_TESTS_FUZZ_BATCH_TARGETS_H_
#define DUET_TESTS_FUZZ_BATCH_TARGETS_H_

#include "absl/strings/string_view.h"
#include "tests/fuzz/promises.h"

namespace duet::fuzz {

// Files of `duet batch`. The digests that they carry are fitted to the input first.
Broken RecipeText(absl::string_view input);
Broken RecipeJson(absl::string_view input);
Broken BatchManifest(absl::string_view input);
Broken BatchJournal(absl::string_view input);  // lines without their digests
Broken BatchJob(absl::string_view input);      // job.json

}  // namespace duet::fuzz

#endif  // DUET_TESTS_FUZZ_BATCH_TARGETS_H_
