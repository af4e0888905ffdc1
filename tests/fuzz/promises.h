#ifndef DUET_TESTS_FUZZ_PROMISES_H_
#define DUET_TESTS_FUZZ_PROMISES_H_

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace duet::fuzz {

// Whatever reads bytes of strangers has a target, a function of the input (*_targets.h). Any input
// at all is a fair one: a fuzzer makes them up, corpus_test runs those that are kept
// (docs/fuzzing.md).
//
// A target returns the promise that the input made the code break ("a clip that was read has no
// frame"), empty when it broke none. That a reader refuses an input is no finding; that it refuses
// it in words that say nothing is one.
using Broken = std::string;

// What every refusal keeps: one of `codes`, and a message of printable lines that is no longer than
// a person would read. Nothing is wrong with OK.
Broken CheckRefusal(const absl::Status& status, std::initializer_list<absl::StatusCode> codes = {
                                                    absl::StatusCode::kInvalidArgument});

// `input` cut at its NUL bytes into `count` parts; the last one takes the rest, absent ones are
// empty.
std::vector<absl::string_view> Parts(absl::string_view input, int count);

// The same bytes for whoever takes the standard's view; a copy could hide a read beyond their end.
inline std::string_view Std(absl::string_view view) { return {view.data(), view.size()}; }

}  // namespace duet::fuzz

#endif  // DUET_TESTS_FUZZ_PROMISES_H_
