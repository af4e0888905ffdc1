#include "server/common/grpc_status.h"

#include <string>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "duet/rpc/v1/status.pb.h"
#include "server/common/error_details.h"

namespace duet::server::common {

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
