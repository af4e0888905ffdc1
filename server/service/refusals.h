#ifndef DUET_SERVER_SERVICE_REFUSALS_H_
#define DUET_SERVER_SERVICE_REFUSALS_H_

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "server/common/error_details.h"
#include "server/registry/model_registry.h"

namespace duet::server::service {

// The errors that the service returns, with google.rpc details.

// Collects every invalid field of a request, so that a caller can correct all of them at once.
//
// Only the first few are kept as text, because trailers are limited to 8 KiB by clients. The others
// are counted.
class Violations {
 public:
  // `prefix`: precedes every field, such as "start.".
  explicit Violations(std::string prefix = "") : prefix_(std::move(prefix)) {}

  // Adds a field that is malformed for every model: "<field>: expected <expected>, got <got>".
  void Malformed(absl::string_view field, absl::string_view expected, absl::string_view got);
  // Adds a field that is well formed but does not fit the model.
  void Mismatch(absl::string_view field, absl::string_view expected, absl::string_view got);

  bool empty() const { return malformed_ + mismatched_ == 0; }

  // Returns OK if empty, INVALID_ARGUMENT if any field is malformed, and FAILED_PRECONDITION if
  // fields only do not fit the model. Errors have BadRequest and ErrorInfo.
  absl::Status ToStatus() const;

 private:
  void Keep(absl::string_view field, absl::string_view expected, absl::string_view got);

  const std::string prefix_;
  std::vector<common::FieldViolation> kept_;
  std::size_t kept_bytes_ = 0;
  std::size_t malformed_ = 0;
  std::size_t mismatched_ = 0;
};

// INVALID_ARGUMENT for one malformed field.
absl::Status Malformed(absl::string_view field, absl::string_view expected, absl::string_view got);

// UNAVAILABLE: the server is loading its models.
absl::Status LoadingRefusal();
// UNAVAILABLE: the server is shutting down. A retry can reach another replica or the restarted
// server.
absl::Status DrainingRefusal();
// RESOURCE_EXHAUSTED: the number of concurrent calls reached the limit, or this client's share of
// it.
absl::Status TooManyCallsRefusal(std::size_t calls, std::size_t limit);
// RESOURCE_EXHAUSTED: the requests of calls in progress reached the limit in bytes, or this
// client's share of it.
absl::Status TooManyBytesRefusal(std::size_t bytes, std::size_t held, std::size_t limit);
// RESOURCE_EXHAUSTED: too many requests arrive slowly.
absl::Status TooManySlowRequestsRefusal(std::size_t limit);
// DEADLINE_EXCEEDED: the request did not arrive, or a reply was not read, within the time limit.
absl::Status ReceiveTimeoutRefusal(double seconds);
// The same for the next message of a live session, which has a time limit of its own.
absl::Status LiveIdleRefusal(double seconds);
absl::Status WriteTimeoutRefusal(double seconds);
// INVALID_ARGUMENT: the call ended without a message.
absl::Status NoMessageRefusal();
// Adds RetryInfo to a RESOURCE_EXHAUSTED of the scheduler. Any other error of the scheduler means
// that the server is shutting down, and becomes DrainingRefusal.
absl::Status QueueRefusal(const absl::Status& scheduler_status);
// RESOURCE_EXHAUSTED: the message is larger than the limit.
absl::Status TooLargeRefusal(std::size_t bytes, std::size_t limit);
// The same for a message of a live session, whose limit no setting changes.
absl::Status LiveMessageTooLargeRefusal(std::size_t bytes, std::size_t limit);
// NOT_FOUND, naming the field that matches no served model.
absl::Status ModelNotFoundRefusal(const registry::ModelNotFound& not_found);
// The status with which a call ends after one of its windows failed with `error`: UNAVAILABLE
// during shutdown, `error` if the call was cancelled or too late, else INTERNAL: the model failed.
// The message then has no details; `cause` gets them, and the log has them under the request ID.
absl::Status WindowFailure(const absl::Status& error, const std::string& request_id,
                           std::string* cause);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_REFUSALS_H_
