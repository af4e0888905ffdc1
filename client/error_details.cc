#include "client/error_details.h"

#include <algorithm>
#include <string_view>

#include "absl/strings/cord.h"
#include "duet/rpc/v1/status.pb.h"

namespace duet::client {
namespace {

// Returns nullopt if the status has no such detail or the detail cannot be parsed.
template <typename Detail>
std::optional<Detail> ReadDetail(const absl::Status& status, std::string_view type) {
  const auto payload = status.GetPayload("type.googleapis.com/google.rpc." + std::string(type));
  Detail detail;
  if (!payload.has_value() || !detail.ParseFromString(std::string(*payload))) return std::nullopt;
  return detail;
}

}  // namespace

std::vector<FieldViolation> FieldViolations(const absl::Status& status) {
  const auto detail = ReadDetail<rpc::v1::BadRequest>(status, "BadRequest");
  if (!detail.has_value()) return {};
  std::vector<FieldViolation> violations;
  for (const rpc::v1::BadRequest::FieldViolation& violation : detail->field_violations()) {
    violations.push_back({violation.field(), violation.description()});
  }
  return violations;
}

std::optional<absl::Duration> RetryDelay(const absl::Status& status) {
  const auto detail = ReadDetail<rpc::v1::RetryInfo>(status, "RetryInfo");
  if (!detail.has_value()) return std::nullopt;
  const absl::Duration delay = absl::Seconds(detail->retry_delay().seconds()) +
                               absl::Nanoseconds(detail->retry_delay().nanos());
  return std::max(delay, absl::ZeroDuration());
}

std::string ErrorReason(const absl::Status& status) {
  const auto detail = ReadDetail<rpc::v1::ErrorInfo>(status, "ErrorInfo");
  return detail.has_value() ? detail->reason() : "";
}

bool IsPermanent(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kFailedPrecondition:
    case absl::StatusCode::kOutOfRange:
    case absl::StatusCode::kNotFound:
    case absl::StatusCode::kAlreadyExists:
    case absl::StatusCode::kPermissionDenied:
    case absl::StatusCode::kUnauthenticated:
    case absl::StatusCode::kUnimplemented:
      return true;
    case absl::StatusCode::kResourceExhausted:
      return !RetryDelay(status).has_value();
    default:
      return false;
  }
}

}  // namespace duet::client
