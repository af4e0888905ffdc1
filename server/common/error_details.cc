#include "server/common/error_details.h"

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

void AddErrorInfo(absl::Status& status, absl::string_view reason,
                  const std::map<std::string, std::string>& metadata) {
  rpc::v1::ErrorInfo detail;
  detail.set_reason(std::string(reason));
  detail.set_domain("duet.v1");
  for (const auto& [key, value] : metadata) (*detail.mutable_metadata())[key] = value;
  AddPayload(status, kErrorInfoUrl, detail);
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

}  // namespace duet::server::common
