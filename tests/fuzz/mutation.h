#ifndef DUET_TESTS_FUZZ_MUTATION_H_
#define DUET_TESTS_FUZZ_MUTATION_H_

#include <string>

#include "absl/strings/string_view.h"
#include "model/base/random.h"

namespace duet::fuzz {

// `input` with one to four things changed: bits, bytes, stretches left out, doubled or taken from
// `other`, numbers replaced by those at which code breaks. The same for the same random numbers.
std::string Mutated(absl::string_view input, absl::string_view other, base::Random& random);

}  // namespace duet::fuzz

#endif  // DUET_TESTS_FUZZ_MUTATION_H_
