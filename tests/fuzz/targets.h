#ifndef DUET_TESTS_FUZZ_TARGETS_H_
#define DUET_TESTS_FUZZ_TARGETS_H_

#include <string>

#include "absl/strings/string_view.h"

namespace duet::fuzz {

// What reads bytes of strangers, one function for each kind of them. Any input at all is a fair
// one: a fuzzer makes them up, corpus_test runs those that are kept (docs/fuzzing.md).
//
// A target returns the promise that the input made the code break ("a clip that was read has no
// frame"), empty when it broke none. That a reader refuses an input is no finding; that it refuses
// it in words that say nothing is one.
using Broken = std::string;

// motion_targets.cc: files of motion, and what describes them.
Broken Bvh(absl::string_view input);
Broken Csv(absl::string_view input);
Broken Gltf(absl::string_view input);
Broken JsonMotion(absl::string_view input);
Broken Npy(absl::string_view input);
Broken SbuText(absl::string_view input);
Broken AsfAmc(absl::string_view input);  // skeleton, NUL, motion
Broken Keyframes(absl::string_view input);
Broken JointMap(absl::string_view input);
Broken DatasetLayout(absl::string_view input);
Broken DatasetIndex(absl::string_view input);

// checkpoint_targets.cc
Broken Checkpoint(absl::string_view input);  // manifest, NUL, weights
Broken Safetensors(absl::string_view input);

// server_targets.cc: what callers send, and what operators write.
Broken SynthesisRequest(absl::string_view input);  // the bytes of a message
Broken SynthesisFields(absl::string_view input);   // the same in text format
Broken ServerConfigText(absl::string_view input);
Broken ServerConfigJson(absl::string_view input);
Broken AccessFile(absl::string_view input);
Broken HttpRequest(absl::string_view input);   // of the metrics port
Broken CallMetadata(absl::string_view input);  // traceparent, request id, peer: a line each

// batch_targets.cc: files of `duet batch`.
Broken RecipeText(absl::string_view input);
Broken RecipeJson(absl::string_view input);
Broken BatchManifest(absl::string_view input);
Broken BatchJournal(absl::string_view input);  // lines without their digests
Broken BatchFolder(absl::string_view input);   // job.json, NUL, summary.json, NUL, index.jsonl
Broken BatchShard(absl::string_view input);    // 't' or 'z', then the archive

}  // namespace duet::fuzz

#endif  // DUET_TESTS_FUZZ_TARGETS_H_
