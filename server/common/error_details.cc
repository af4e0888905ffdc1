#include "server/common/error_details.h"

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>

#include <cstdint>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "duet/rpc/v1/status.pb.h"

namespace duet::server::common {
namespace {

void AddPayload(absl::Status& status, absl::string_view url,
                const google::protobuf::MessageLite& detail) {
  status.SetPayload({url.data(), url.size()}, absl::Cord(detail.SerializeAsString()));
}

}  // namespace

void AddBadRequest(absl::Status& status, const std::vector<FieldViolation>& violations) {
  rpc::v1::BadRequest detail;
  for (const FieldViolation& violation : violations) {
    auto* added = detail.add_field_violations();
    added->set_field(violation.field);
    added->set_description(violation.description);
  }
  AddPayload(status, kBadRequestUrl, detail);
}

void AddRetryInfo(absl::Status& status, absl::Duration delay) {
  rpc::v1::RetryInfo detail;
  const int64_t nanoseconds = absl::ToInt64Nanoseconds(delay);
  detail.mutable_retry_delay()->set_seconds(nanoseconds / 1'000'000'000);
  detail.mutable_retry_delay()->set_nanos(static_cast<int32_t>(nanoseconds % 1'000'000'000));
  AddPayload(status, kRetryInfoUrl, detail);
}

absl::Status WithInfo(absl::Status status, absl::string_view reason,
                      const std::map<std::string, std::string>& metadata) {
  rpc::v1::ErrorInfo detail;
  detail.set_reason(std::string(reason));
  detail.set_domain("duet.v1");
  for (const auto& [key, value] : metadata) (*detail.mutable_metadata())[key] = value;
  AddPayload(status, kErrorInfoUrl, detail);
  return status;
}

std::string ReasonOf(const absl::Status& status) {
  const auto payload = status.GetPayload({kErrorInfoUrl.data(), kErrorInfoUrl.size()});
  rpc::v1::ErrorInfo detail;
  if (!payload.has_value() || !detail.ParseFromString(std::string(*payload))) return "";
  return detail.reason();
}

absl::Status Join(const std::vector<absl::Status>& statuses) {
  absl::Status joined;
  for (const absl::Status& status : statuses) {
    if (status.ok()) continue;
    joined = joined.ok() ? status
                         : absl::Status(joined.code(),
                                        absl::StrCat(joined.message(), "\n", status.message()));
  }
  return joined;
}

grpc::Status ToGrpcStatus(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  const std::string message(status.message());
  rpc::v1::Status details;
  details.set_code(static_cast<int>(status.code()));
  details.set_message(message);
  status.ForEachPayload([&details](absl::string_view url, const absl::Cord& payload) {
    auto* detail = details.add_details();
    detail->set_type_url(std::string(url));
    detail->set_value(std::string(payload));
  });
  // absl and gRPC use the same numbers for codes.
  return grpc::Status(static_cast<grpc::StatusCode>(status.code()), message,
                      details.details().empty() ? "" : details.SerializeAsString());
}

void AddRetryPushback(const absl::Status& status, grpc::ServerContextBase& context) {
  const auto payload = status.GetPayload({kRetryInfoUrl.data(), kRetryInfoUrl.size()});
  rpc::v1::RetryInfo retry;
  if (!payload.has_value() || !retry.ParseFromString(std::string(*payload))) return;
  const int64_t milliseconds =
      retry.retry_delay().seconds() * 1000 + retry.retry_delay().nanos() / 1'000'000;
  context.AddTrailingMetadata("grpc-retry-pushback-ms", absl::StrCat(milliseconds));
}

}  // namespace duet::server::common
