#include "client/cli/exit_code.h"

#include "client/error_details.h"

namespace duet::client::cli {

ExitCode ExitCodeFor(const absl::Status& status) {
  if (status.ok()) return kExitDone;
  return IsPermanent(status) ? kExitBadInput : kExitRetry;
}

}  // namespace duet::client::cli
