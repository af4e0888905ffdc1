#include "client/cli/exit_code.h"

#include "client/error_details.h"

namespace duet::client::cli {

ExitCode ExitCodeFor(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kOk:
      return kExitDone;
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kFailedPrecondition:
    case absl::StatusCode::kOutOfRange:
    case absl::StatusCode::kNotFound:
    case absl::StatusCode::kAlreadyExists:
    case absl::StatusCode::kPermissionDenied:
    case absl::StatusCode::kUnauthenticated:
    case absl::StatusCode::kUnimplemented:
      return kExitBadInput;
    case absl::StatusCode::kResourceExhausted:
      return RetryDelay(status).has_value() ? kExitRetry : kExitBadInput;
    default:
      return kExitRetry;
  }
}

}  // namespace duet::client::cli
