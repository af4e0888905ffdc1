#ifndef DUET_SERVER_SERVICE_REFUSALS_H_
#define DUET_SERVER_SERVICE_REFUSALS_H_

#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "server/registry/model_registry.h"

namespace duet::server::service {

// What callers are told when the server cannot or will not answer, complete with google.rpc
// details. Refusals of malformed requests come from Violations.

// UNAVAILABLE: models are still being loaded.
absl::Status LoadingRefusal();
// UNAVAILABLE: the server is going away; another replica, or this one restarted, will answer.
absl::Status DrainingRefusal();
// RESOURCE_EXHAUSTED: as many calls are being answered as the limit, or this client's share of it,
// allows.
absl::Status TooManyCallsRefusal(std::size_t calls, std::size_t limit);
// RESOURCE_EXHAUSTED: the requests of calls being answered hold as many bytes as the limit, or this
// client's share of it, allows.
absl::Status TooManyBytesRefusal(std::size_t bytes, std::size_t held, std::size_t limit);
// RESOURCE_EXHAUSTED: as many requests are long on their way as may be.
absl::Status TooManySlowRequestsRefusal(std::size_t limit);
// DEADLINE_EXCEEDED: the request, or its answer's reader, took longer than the server waits.
absl::Status ReceiveTimeoutRefusal(double seconds);
absl::Status WriteTimeoutRefusal(double seconds);
// RESOURCE_EXHAUSTED: others waited for the place of a call whose reader took nothing for so long.
absl::Status StalledReaderRefusal(double seconds);
// INVALID_ARGUMENT: the call ended without a message.
absl::Status NoMessageRefusal();
// RESOURCE_EXHAUSTED: the scheduler's refusal with RetryInfo. Other codes: DrainingRefusal, the
// only other cause.
absl::Status QueueRefusal(const absl::Status& scheduler_status);
// RESOURCE_EXHAUSTED: the message is larger than the limit.
absl::Status TooLargeRefusal(std::size_t bytes, std::size_t limit);
// NOT_FOUND, naming the field that nothing answers to.
absl::Status ModelNotFoundRefusal(const registry::ModelNotFound& not_found);
// INTERNAL: the model failed. The text does not say why; the log does, under the request id.
absl::Status ModelFailedRefusal(const std::string& request_id);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_REFUSALS_H_
