#ifndef DUET_TESTS_SERVER_SUPPORT_REFUSAL_H_
#define DUET_TESTS_SERVER_SUPPORT_REFUSAL_H_

#include <grpcpp/support/status.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"

namespace duet::test {

// A rejection as a client decodes it.
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

// Decodes the google.rpc details of a status from the wire. Fails the test if they are malformed or
// contradict the status.
Refusal Decode(const grpc::Status& status);
// Does the same for a status that has not been sent.
Refusal Decode(const absl::Status& status);

}  // namespace duet::test

#endif  // DUET_TESTS_SERVER_SUPPORT_REFUSAL_H_
