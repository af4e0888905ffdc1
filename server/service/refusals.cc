#include "server/service/refusals.h"

#include <map>

#include "absl/strings/str_cat.h"
#include "absl/time/time.h"

namespace duet::server::service {
namespace {

constexpr std::size_t kMaxKept = 24;
constexpr std::size_t kMaxKeptBytes = 2000;
constexpr std::size_t kMaxDescriptionBytes = 240;
// Number of violations in grpc-message, for people who see only the text.
constexpr std::size_t kInMessage = 2;

// Long enough for a queue to move or a replica to start, short enough for a person.
constexpr absl::Duration kRetryDelay = absl::Seconds(1);

absl::Status Retryable(absl::Status status, absl::string_view reason,
                       const std::map<std::string, std::string>& metadata = {}) {
  common::AddRetryInfo(status, kRetryDelay);
  return common::WithInfo(std::move(status), reason, metadata);
}

absl::Status Expired(absl::string_view what, double seconds, absl::string_view reason) {
  return common::WithInfo(absl::DeadlineExceededError(absl::StrCat(what, seconds)), reason);
}

}  // namespace

void Violations::Malformed(absl::string_view field, absl::string_view expected,
                           absl::string_view got) {
  ++malformed_;
  Keep(field, expected, got);
}

void Violations::Mismatch(absl::string_view field, absl::string_view expected,
                          absl::string_view got) {
  ++mismatched_;
  Keep(field, expected, got);
}

void Violations::Keep(absl::string_view field, absl::string_view expected, absl::string_view got) {
  std::string name = absl::StrCat(prefix_, field);
  std::string description = absl::StrCat("expected ", expected, ", got ", got);
  // Descriptions are ASCII (see Quoted), so they can be cut anywhere.
  if (description.size() > kMaxDescriptionBytes) {
    description.resize(kMaxDescriptionBytes);
    description += "...";
  }
  const std::size_t bytes = name.size() + description.size();
  if (kept_.size() >= kMaxKept || kept_bytes_ + bytes > kMaxKeptBytes) return;
  kept_bytes_ += bytes;
  kept_.push_back({std::move(name), std::move(description)});
}

absl::Status Violations::ToStatus() const {
  if (empty()) return absl::OkStatus();
  const std::size_t count = malformed_ + mismatched_;
  std::string message;
  for (std::size_t i = 0; i < kept_.size() && i < kInMessage; ++i) {
    absl::StrAppend(&message, i == 0 ? "" : "; ", kept_[i].field,
                    kept_[i].field.empty() ? "" : ": ", kept_[i].description);
  }
  if (count > kInMessage) absl::StrAppend(&message, "; and ", count - kInMessage, " more");

  std::vector<common::FieldViolation> violations = kept_;
  if (count > kept_.size()) {
    violations.push_back(
        {"", absl::StrCat(count - kept_.size(), " further violations are not listed")});
  }
  absl::Status status =
      malformed_ > 0 ? absl::InvalidArgumentError(message) : absl::FailedPreconditionError(message);
  AddBadRequest(status, violations);
  return common::WithInfo(std::move(status), malformed_ > 0 ? common::kReasonInvalidRequest
                                                            : common::kReasonModelMismatch);
}

absl::Status Malformed(absl::string_view field, absl::string_view expected, absl::string_view got) {
  Violations violations;
  violations.Malformed(field, expected, got);
  return violations.ToStatus();
}

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
  return Expired("the request did not arrive within receive_timeout_seconds = ", seconds,
                 common::kReasonReceiveTimeout);
}

absl::Status LiveIdleRefusal(double seconds) {
  return Expired("the live session got no message for live_idle_seconds = ", seconds,
                 common::kReasonReceiveTimeout);
}

absl::Status WriteTimeoutRefusal(double seconds) {
  return Expired("the caller read no reply for write_timeout_seconds = ", seconds,
                 common::kReasonWriteTimeout);
}

absl::Status NoMessageRefusal() {
  return common::WithInfo(
      absl::InvalidArgumentError("expected a request, got none or one of more than twice "
                                 "max_request_bytes, which the transport rejects"),
      common::kReasonInvalidRequest);
}

absl::Status QueueRefusal(const absl::Status& scheduler_status) {
  if (!absl::IsResourceExhausted(scheduler_status)) return DrainingRefusal();
  return Retryable(scheduler_status, common::kReasonQueueFull);
}

absl::Status TooLargeRefusal(std::size_t bytes, std::size_t limit) {
  return common::WithInfo(
      absl::ResourceExhaustedError(absl::StrCat(
          "request: expected at most max_request_bytes = ", limit, " bytes, got ", bytes)),
      common::kReasonRequestTooLarge,
      {{"max_request_bytes", absl::StrCat(limit)}, {"request_bytes", absl::StrCat(bytes)}});
}

absl::Status LiveMessageTooLargeRefusal(std::size_t bytes, std::size_t limit) {
  return common::WithInfo(
      absl::ResourceExhaustedError(absl::StrCat("message of a live session: expected at most ",
                                                limit, " bytes, got ", bytes)),
      common::kReasonRequestTooLarge,
      {{"max_message_bytes", absl::StrCat(limit)}, {"message_bytes", absl::StrCat(bytes)}});
}

absl::Status ModelNotFoundRefusal(const registry::ModelNotFound& not_found) {
  absl::Status status =
      absl::NotFoundError(absl::StrCat(not_found.field, ": ", not_found.description));
  common::AddBadRequest(status, {{not_found.field, not_found.description}});
  return common::WithInfo(std::move(status), common::kReasonModelNotFound);
}

absl::Status WindowFailure(const absl::Status& error, const std::string& request_id,
                           std::string* cause) {
  if (absl::IsUnavailable(error)) return DrainingRefusal();
  // The caller's doing, not the model's.
  if (absl::IsCancelled(error) || absl::IsDeadlineExceeded(error)) return error;
  *cause = error.ToString();
  return common::WithInfo(
      absl::InternalError(absl::StrCat(
          "the model failed; the server's log has the reason under request_id ", request_id)),
      common::kReasonModelFailed, {{"request_id", request_id}});
}

}  // namespace duet::server::service
