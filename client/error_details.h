#ifndef DUET_CLIENT_ERROR_DETAILS_H_
#define DUET_CLIENT_ERROR_DETAILS_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/time/time.h"

namespace duet::client {

// An invalid field of a request.
struct FieldViolation {
  std::string field;        // such as "leader.positions[17]"
  std::string description;  // the expected and the received value
};

// The functions below read the google.rpc details of an error (BadRequest, RetryInfo, ErrorInfo). A
// status from this library carries them as payloads.

// Returns every invalid field, in the server's order. Empty if the error has no BadRequest.
std::vector<FieldViolation> FieldViolations(const absl::Status& status);

// Returns the delay after which to retry. Absent if the error has no RetryInfo.
std::optional<absl::Duration> RetryDelay(const absl::Status& status);

// Returns a stable, machine-readable reason such as "QUEUE_FULL". Empty if the status did not come
// from a Duet server.
std::string ErrorReason(const absl::Status& status);

// Returns true if a retry of the same call would fail too, because the server rejects the input,
// the model or the credentials: INVALID_ARGUMENT, FAILED_PRECONDITION, OUT_OF_RANGE, NOT_FOUND,
// ALREADY_EXISTS, PERMISSION_DENIED, UNAUTHENTICATED, UNIMPLEMENTED, and RESOURCE_EXHAUSTED without
// RetryInfo (the message is too large).
bool IsPermanent(const absl::Status& status);

}  // namespace duet::client

#endif  // DUET_CLIENT_ERROR_DETAILS_H_
