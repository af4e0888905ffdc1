#ifndef DUET_TESTS_FUZZ_CAPTURE_TARGETS_H_
#define DUET_TESTS_FUZZ_CAPTURE_TARGETS_H_

#include "absl/strings/string_view.h"
#include "tests/fuzz/promises.h"

namespace duet::fuzz {

// Streams of motion capture: datagrams one after another, each after a header of four bytes: the
// milliseconds since the one before, the sender, and the length in two bytes, big-endian. A length
// beyond the end takes the rest.
Broken Vmc(absl::string_view input);
Broken Xsens(absl::string_view input);
Broken Rokoko(absl::string_view input);

}  // namespace duet::fuzz

#endif  // DUET_TESTS_FUZZ_CAPTURE_TARGETS_H_
