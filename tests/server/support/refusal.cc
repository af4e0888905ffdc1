#include "tests/server/support/refusal.h"

#include <gtest/gtest.h>

#include "duet/rpc/v1/status.pb.h"
#include "server/common/error_details.h"

namespace duet::test {

std::string Refusal::Of(const std::string& field) const {
  for (const auto& [name, description] : violations) {
    if (name == field) return description;
  }
  return "";
}

std::vector<std::string> Refusal::Fields() const {
  std::vector<std::string> fields;
  for (const auto& violation : violations) fields.push_back(violation.first);
  return fields;
}

Refusal Decode(const grpc::Status& status) {
  Refusal refusal;
  refusal.code = static_cast<absl::StatusCode>(status.error_code());
  refusal.message = status.error_message();
  if (status.error_details().empty()) return refusal;
  rpc::v1::Status details;
  EXPECT_TRUE(details.ParseFromString(status.error_details()));
  EXPECT_EQ(details.code(), status.error_code());
  EXPECT_EQ(details.message(), status.error_message());
  for (const auto& detail : details.details()) {
    if (detail.type_url() == "type.googleapis.com/google.rpc.BadRequest") {
      rpc::v1::BadRequest bad_request;
      EXPECT_TRUE(bad_request.ParseFromString(detail.value()));
      for (const auto& violation : bad_request.field_violations()) {
        refusal.violations.emplace_back(violation.field(), violation.description());
      }
    } else if (detail.type_url() == "type.googleapis.com/google.rpc.ErrorInfo") {
      rpc::v1::ErrorInfo info;
      EXPECT_TRUE(info.ParseFromString(detail.value()));
      EXPECT_EQ(info.domain(), "duet.v1");
      refusal.reason = info.reason();
      refusal.metadata = {info.metadata().begin(), info.metadata().end()};
    } else if (detail.type_url() == "type.googleapis.com/google.rpc.RetryInfo") {
      rpc::v1::RetryInfo retry;
      EXPECT_TRUE(retry.ParseFromString(detail.value()));
      refusal.retry_seconds =
          static_cast<double>(retry.retry_delay().seconds()) + 1e-9 * retry.retry_delay().nanos();
    } else {
      ADD_FAILURE() << "unknown detail " << detail.type_url();
    }
  }
  return refusal;
}

Refusal Decode(const absl::Status& status) { return Decode(server::common::ToGrpcStatus(status)); }

}  // namespace duet::test
