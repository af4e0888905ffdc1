#ifndef DUET_TESTS_SERVER_SUPPORT_REFUSAL_H_
#define DUET_TESTS_SERVER_SUPPORT_REFUSAL_H_

#include <grpcpp/support/status.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"

namespace duet::test {

// A refusal as a client decodes it.
struct Refusal {
  absl::StatusCode code = absl::StatusCode::kOk;
  std::string message;
  std::vector<std::pair<std::string, std::string>> violations;  // field, description
  std::string reason;                                           // of ErrorInfo
  std::map<std::string, std::string> metadata;                  // of ErrorInfo
  double retry_seconds = -1;                                    // of RetryInfo, if any

  // The description of the first violation of a field, or "".
  std::string Of(const std::string& field) const;
  std::vector<std::string> Fields() const;
};

// Reads google.rpc details from a status that came over the wire. A test failure when they are
// malformed or contradict the status.
Refusal Decode(const grpc::Status& status);
// The same for a status before it went onto the wire.
Refusal Decode(const absl::Status& status);

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_REFUSAL_H_
