#ifndef DUET_SERVER_COMMON_ERROR_DETAILS_H_
#define DUET_SERVER_COMMON_ERROR_DETAILS_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "absl/time/time.h"

namespace grpc {
class ServerContextBase;
class Status;
}  // namespace grpc

namespace duet::server::common {

// A field of a rejected request.
struct FieldViolation {
  std::string field;        // path, such as "leader.positions[17]"
  std::string description;  // what the field has and what was expected
};

// google.rpc error details, attached to a status as payloads under their type URLs.
inline constexpr absl::string_view kBadRequestUrl = "type.googleapis.com/google.rpc.BadRequest";
inline constexpr absl::string_view kRetryInfoUrl = "type.googleapis.com/google.rpc.RetryInfo";
inline constexpr absl::string_view kErrorInfoUrl = "type.googleapis.com/google.rpc.ErrorInfo";

// Stable reasons of ErrorInfo. Part of the contract: never renamed.
inline constexpr absl::string_view kReasonInvalidRequest = "INVALID_REQUEST";
inline constexpr absl::string_view kReasonModelMismatch = "MODEL_MISMATCH";
inline constexpr absl::string_view kReasonModelNotFound = "MODEL_NOT_FOUND";
inline constexpr absl::string_view kReasonRequestTooLarge = "REQUEST_TOO_LARGE";
inline constexpr absl::string_view kReasonTooManyCalls = "TOO_MANY_CALLS";
inline constexpr absl::string_view kReasonTooManyBytes = "TOO_MANY_BYTES";
inline constexpr absl::string_view kReasonReceiveTimeout = "RECEIVE_TIMEOUT";
inline constexpr absl::string_view kReasonWriteTimeout = "WRITE_TIMEOUT";
inline constexpr absl::string_view kReasonQueueFull = "QUEUE_FULL";
inline constexpr absl::string_view kReasonLoading = "SERVER_LOADING";
inline constexpr absl::string_view kReasonDraining = "SERVER_DRAINING";
inline constexpr absl::string_view kReasonModelFailed = "MODEL_FAILED";
inline constexpr absl::string_view kReasonCredentialsMissing = "CREDENTIALS_MISSING";
inline constexpr absl::string_view kReasonCredentialsInvalid = "CREDENTIALS_INVALID";
inline constexpr absl::string_view kReasonCallerUnknown = "CALLER_UNKNOWN";
inline constexpr absl::string_view kReasonRoleMissing = "ROLE_MISSING";
inline constexpr absl::string_view kReasonCallRate = "CALL_RATE_EXCEEDED";

void AddBadRequest(absl::Status& status, const std::vector<FieldViolation>& violations);
void AddRetryInfo(absl::Status& status, absl::Duration delay);
// Returns the status with an ErrorInfo.
absl::Status WithInfo(absl::Status status, absl::string_view reason,
                      const std::map<std::string, std::string>& metadata = {});

// Returns the reason in a status's ErrorInfo, or an empty string if there is none.
std::string ReasonOf(const absl::Status& status);

// Returns all failures as one status: the code of the first, and one message per line. OK if none
// failed.
absl::Status Join(const std::vector<absl::Status>& statuses);

// Converts a status for the wire; the only place that does. Code and message stay as they are,
// payloads become google.rpc.Status in grpc-status-details-bin.
grpc::Status ToGrpcStatus(const absl::Status& status);
// Sends the delay of the status's RetryInfo as grpc-retry-pushback-ms, which gRPC's built-in
// retries follow. Does nothing if the status has no RetryInfo.
void AddRetryPushback(const absl::Status& status, grpc::ServerContextBase& context);

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_ERROR_DETAILS_H_
