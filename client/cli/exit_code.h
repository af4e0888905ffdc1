#ifndef DUET_CLIENT_CLI_EXIT_CODE_H_
#define DUET_CLIENT_CLI_EXIT_CODE_H_

#include "absl/status/status.h"

namespace duet::client::cli {

// What the program tells its caller, such as a job scheduler.
enum ExitCode : int {
  kExitDone = 0,
  kExitRetry = 1,      // the same call may succeed later
  kExitUsage = 2,      // the command line makes no sense
  kExitBadInput = 42,  // the same call will never succeed: input, model or credentials
};

// The exit code for a call or a file that failed with `status`.
//
//   0   OK
//   42  INVALID_ARGUMENT, FAILED_PRECONDITION, OUT_OF_RANGE, NOT_FOUND, ALREADY_EXISTS,
//       PERMISSION_DENIED, UNAUTHENTICATED, UNIMPLEMENTED; RESOURCE_EXHAUSTED where the server does
//       not say when to come back (the message is too large)
//   1   everything else
ExitCode ExitCodeFor(const absl::Status& status);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_EXIT_CODE_H_
