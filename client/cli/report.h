#ifndef DUET_CLIENT_CLI_REPORT_H_
#define DUET_CLIENT_CLI_REPORT_H_

#include <string>

#include "absl/status/status.h"
#include "client/error_details.h"
#include "nlohmann/json_fwd.hpp"

namespace duet::client::cli {

// The result that the program reports to its caller, such as a job scheduler.
enum ExitCode : int {
  kExitDone = 0,
  kExitRetry = 1,      // the same call may succeed later
  kExitUsage = 2,      // the command line is invalid
  kExitBadInput = 42,  // the same call will never succeed: input, model or credentials
};

// The exit code for a call or a file that failed with `status`; IsPermanent says which code.
inline ExitCode ExitCodeFor(const absl::Status& status) {
  if (status.ok()) return kExitDone;
  return IsPermanent(status) ? kExitBadInput : kExitRetry;
}

// The end of --help of the program and of duet synthesize.
inline constexpr char kExitCodesFooter[] = R"(
Exit codes:
  0   done
  1   failed, but the same call may succeed later (server away, busy or draining; a full disk)
  2   the command line or a setting is invalid
  42  failed, and will fail again: the input, the model or the credentials are rejected

Example:
  duet synthesize --leader kick.bvh --label kick=1 --out pair.html --out pair.bvh
)";

// The error, with one line for every rejected field, and a hint.
std::string DescribeFailure(const absl::Status& status, const std::string& server_address);
// The flag that fixes how a file was read: "Specify it with --frame-rate HZ.\n"; empty if there is
// none.
std::string DescribeAdvice(const absl::Status& status);

// The JSON text that this program prints.
std::string Print(const nlohmann::json& value);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_REPORT_H_
