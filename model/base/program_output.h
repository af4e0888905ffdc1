#ifndef DUET_MODEL_BASE_PROGRAM_OUTPUT_H_
#define DUET_MODEL_BASE_PROGRAM_OUTPUT_H_

#include <iosfwd>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace duet::base {

// Flushes standard output. ABORTED if something that was written to it did not arrive: a full disk,
// a closed pipe.
absl::Status FlushOutput(std::ostream* out);

// For the end of main: returns the program's exit code. That is `code`, unless it is 0 and standard
// output could not be written; then it is 1, and standard error has the reason.
int FinishOutput(absl::string_view program, int code, std::ostream* out, std::ostream* err);
// The same with the standard streams.
int FinishOutput(absl::string_view program, int code);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_PROGRAM_OUTPUT_H_
