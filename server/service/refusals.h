#ifndef DUET_SERVER_SERVICE_REFUSALS_H_
#define DUET_SERVER_SERVICE_REFUSALS_H_

#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "server/registry/model_registry.h"

namespace duet::server::service {

// The errors that the service returns, with google.rpc details. Violations creates the errors for
// malformed requests.

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
// INTERNAL: the model failed. The message has no details; the log has them under the request ID.
absl::Status ModelFailedRefusal(const std::string& request_id);

// The status with which a call ends after one of its windows failed with `error`: UNAVAILABLE
// during shutdown, INTERNAL if the model failed, else `error`. `cause` gets the details of a model
// failure.
absl::Status WindowFailure(const absl::Status& error, const std::string& request_id,
                           std::string* cause);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_REFUSALS_H_
