#include "server/service/refusals.h"

#include <map>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/time/time.h"
#include "server/common/error_details.h"

namespace duet::server::service {
namespace {

// Long enough for a queue to move or a replica to start, short enough for a person.
constexpr absl::Duration kRetryDelay = absl::Seconds(1);

absl::Status Retryable(absl::Status status, absl::string_view reason,
                       const std::map<std::string, std::string>& metadata = {}) {
  common::AddErrorInfo(status, reason, metadata);
  common::AddRetryInfo(status, kRetryDelay);
  return status;
}

}  // namespace

absl::Status LoadingRefusal() {
  return Retryable(absl::UnavailableError("the server is loading its models"),
                   common::kReasonLoading);
}

absl::Status DrainingRefusal() {
  return Retryable(absl::UnavailableError("the server is shutting down"), common::kReasonDraining);
}

absl::Status TooManyCallsRefusal(std::size_t calls, std::size_t limit) {
  return Retryable(absl::ResourceExhaustedError(absl::StrCat(
                       "calls in progress: expected at most ", limit,
                       " of this priority and only a share of them for one client, got ", calls)),
                   common::kReasonTooManyCalls, {{"max_calls", absl::StrCat(limit)}});
}

absl::Status TooManyBytesRefusal(std::size_t bytes, std::size_t held, std::size_t limit) {
  return Retryable(
      absl::ResourceExhaustedError(absl::StrCat(
          "requests in progress: expected at most max_held_bytes = ", limit,
          " bytes and only a share of them for one client, got ", bytes, " in addition to ", held)),
      common::kReasonTooManyBytes, {{"max_held_bytes", absl::StrCat(limit)}});
}

absl::Status TooManySlowRequestsRefusal(std::size_t limit) {
  return Retryable(absl::ResourceExhaustedError(
                       absl::StrCat("slow requests: expected at most ", limit,
                                    " and only a share of them for one client, got one more")),
                   common::kReasonTooManyBytes);
}

absl::Status ReceiveTimeoutRefusal(double seconds) {
  absl::Status status = absl::DeadlineExceededError(
      absl::StrCat("the request did not arrive within receive_timeout_seconds = ", seconds));
  common::AddErrorInfo(status, common::kReasonReceiveTimeout);
  return status;
}

absl::Status LiveIdleRefusal(double seconds) {
  absl::Status status = absl::DeadlineExceededError(
      absl::StrCat("the live session got no message for live_idle_seconds = ", seconds));
  common::AddErrorInfo(status, common::kReasonReceiveTimeout);
  return status;
}

absl::Status WriteTimeoutRefusal(double seconds) {
  absl::Status status = absl::DeadlineExceededError(
      absl::StrCat("the caller read no reply for write_timeout_seconds = ", seconds));
  common::AddErrorInfo(status, common::kReasonWriteTimeout);
  return status;
}

absl::Status NoMessageRefusal() {
  absl::Status status = absl::InvalidArgumentError(
      "expected a request, got none or one of more than twice max_request_bytes, which the "
      "transport rejects");
  common::AddErrorInfo(status, common::kReasonInvalidRequest);
  return status;
}

absl::Status QueueRefusal(const absl::Status& scheduler_status) {
  if (!absl::IsResourceExhausted(scheduler_status)) return DrainingRefusal();
  return Retryable(scheduler_status, common::kReasonQueueFull);
}

absl::Status TooLargeRefusal(std::size_t bytes, std::size_t limit) {
  absl::Status status = absl::ResourceExhaustedError(
      absl::StrCat("request: expected at most max_request_bytes = ", limit, " bytes, got ", bytes));
  common::AddErrorInfo(
      status, common::kReasonRequestTooLarge,
      {{"max_request_bytes", absl::StrCat(limit)}, {"request_bytes", absl::StrCat(bytes)}});
  return status;
}

absl::Status LiveMessageTooLargeRefusal(std::size_t bytes, std::size_t limit) {
  absl::Status status = absl::ResourceExhaustedError(
      absl::StrCat("message of a live session: expected at most ", limit, " bytes, got ", bytes));
  common::AddErrorInfo(
      status, common::kReasonRequestTooLarge,
      {{"max_message_bytes", absl::StrCat(limit)}, {"message_bytes", absl::StrCat(bytes)}});
  return status;
}

absl::Status ModelNotFoundRefusal(const registry::ModelNotFound& not_found) {
  absl::Status status =
      absl::NotFoundError(absl::StrCat(not_found.field, ": ", not_found.description));
  common::AddBadRequest(status, {{not_found.field, not_found.description}});
  common::AddErrorInfo(status, common::kReasonModelNotFound);
  return status;
}

absl::Status ModelFailedRefusal(const std::string& request_id) {
  absl::Status status = absl::InternalError(absl::StrCat(
      "the model failed; the server's log has the reason under request_id ", request_id));
  common::AddErrorInfo(status, common::kReasonModelFailed, {{"request_id", request_id}});
  return status;
}

absl::Status WindowFailure(const absl::Status& error, const std::string& request_id,
                           std::string* cause) {
  if (absl::IsUnavailable(error)) return DrainingRefusal();
  // The caller's doing, not the model's.
  if (absl::IsCancelled(error) || absl::IsDeadlineExceeded(error)) return error;
  *cause = error.ToString();
  return ModelFailedRefusal(request_id);
}

}  // namespace duet::server::service
