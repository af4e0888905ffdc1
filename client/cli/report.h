#ifndef DUET_CLIENT_CLI_REPORT_H_
#define DUET_CLIENT_CLI_REPORT_H_

#include <string>

#include "absl/status/status.h"
#include "nlohmann/json_fwd.hpp"

namespace duet::client::cli {

// What the commands print alike. Every text ends with a newline.

// The error, with one line for every rejected field, and a hint.
std::string DescribeFailure(const absl::Status& status, const std::string& server_address);
// The flag that fixes how a file was read: "Specify it with --frame-rate HZ.\n"; empty if there is
// none.
std::string DescribeAdvice(const absl::Status& status);

// The JSON text that this program prints.
std::string Print(const nlohmann::json& value);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_REPORT_H_
