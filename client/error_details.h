#ifndef DUET_CLIENT_ERROR_DETAILS_H_
#define DUET_CLIENT_ERROR_DETAILS_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/time/time.h"

namespace duet::client {

// A field of a request that the server refused.
struct FieldViolation {
  std::string field;        // such as "leader.positions[17]"
  std::string description;  // what came and what was wanted
};

// The functions below read the details of a server's refusal (google.rpc.BadRequest, RetryInfo,
// ErrorInfo), which a status from this library carries as payloads.

// Every field that was refused, in the server's order; empty where the refusal is of another kind.
std::vector<FieldViolation> FieldViolations(const absl::Status& status);

// When the server wants to be asked again; absent where it did not say.
std::optional<absl::Duration> RetryDelay(const absl::Status& status);

// A stable, machine-readable reason such as "QUEUE_FULL"; empty where the status did not come from
// a Duet server.
std::string ErrorReason(const absl::Status& status);

// Whether the same call will fail again however often it is made: the input, the model or the
// credentials are refused. INVALID_ARGUMENT, FAILED_PRECONDITION, OUT_OF_RANGE, NOT_FOUND,
// ALREADY_EXISTS, PERMISSION_DENIED, UNAUTHENTICATED, UNIMPLEMENTED; RESOURCE_EXHAUSTED where the
// server does not say when to come back (the message is too large).
bool IsPermanent(const absl::Status& status);

}  // namespace duet::client

#endif  // DUET_CLIENT_ERROR_DETAILS_H_
