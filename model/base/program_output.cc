#include "model/base/program_output.h"

#include <cerrno>
#include <iostream>
#include <system_error>

#include "absl/strings/str_cat.h"

namespace duet::base {

absl::Status FlushOutput(std::ostream* out) {
  errno = 0;
  out->flush();
  if (out->good()) return absl::OkStatus();
  // An earlier write may have failed, and its reason is gone.
  const std::error_code why(errno, std::generic_category());
  return absl::AbortedError(
      absl::StrCat("standard output: cannot write all of it", why ? ": " + why.message() : ""));
}

int FinishOutput(absl::string_view program, int code, std::ostream* out, std::ostream* err) {
  const absl::Status written = FlushOutput(out);
  if (written.ok() || code != 0) return code;
  *err << program << ": " << written.message() << "\n";
  return 1;
}

int FinishOutput(absl::string_view program, int code) {
  return FinishOutput(program, code, &std::cout, &std::cerr);
}

}  // namespace duet::base
