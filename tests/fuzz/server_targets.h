#ifndef DUET_TESTS_FUZZ_SERVER_TARGETS_H_
#define DUET_TESTS_FUZZ_SERVER_TARGETS_H_

#include "absl/strings/string_view.h"
#include "tests/fuzz/promises.h"

namespace duet::fuzz {

// What callers send, and what operators write.
Broken SynthesisRequest(absl::string_view input);  // the bytes of a message
Broken SynthesisFields(absl::string_view input);   // the same in text format
Broken ServerConfigText(absl::string_view input);
Broken AccessFile(absl::string_view input);
Broken CallMetadata(absl::string_view input);  // traceparent, request id, peer: a line each

}  // namespace duet::fuzz

#endif  // DUET_TESTS_FUZZ_SERVER_TARGETS_H_
