#ifndef DUET_CLIENT_CLI_REQUEST_FILE_H_
#define DUET_CLIENT_CLI_REQUEST_FILE_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "client/request.h"

namespace duet::client::cli {

// Reads a duet.v1.SynthesizeRequest in protobuf's text format. The leader, which may be absent, is
// in metres, y up; reply_joint_names is not supported.
//
// Errors: INVALID_ARGUMENT "FILE: line 3:5: ..." for text that is no such message, and "FILE:
// field: expected ..., got ..."; those of reading a file. The server checks what depends on the
// model.
absl::StatusOr<SynthesisRequest> ReadRequestFile(const std::filesystem::path& file);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_REQUEST_FILE_H_
