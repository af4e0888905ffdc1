#include "client/internal/grpc_status.h"

#include <string>

#include "client/error_details.h"
#include "duet/rpc/v1/status.pb.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client::internal {
namespace {

using ::testing::Eq;

void Pack(const google::protobuf::Message& detail, const std::string& type,
          rpc::v1::Status* status) {
  google::protobuf::Any* any = status->add_details();
  any->set_type_url("type.googleapis.com/google.rpc." + type);
  any->set_value(detail.SerializeAsString());
}

rpc::v1::BadRequest TwoViolations() {
  rpc::v1::BadRequest bad;
  rpc::v1::BadRequest::FieldViolation* first = bad.add_field_violations();
  first->set_field("leader.frame_rate_hz");
  first->set_description("0, expected 1 to 240");
  rpc::v1::BadRequest::FieldViolation* second = bad.add_field_violations();
  second->set_field("label_vector");
  second->set_description("empty, expected at least one weight");
  return bad;
}

grpc::Status Refusal(const std::string& message, const rpc::v1::Status& details) {
  return {grpc::StatusCode::INVALID_ARGUMENT, message, details.SerializeAsString()};
}

TEST(FromGrpcTest, EveryFieldViolationIsNamedInTheMessage) {
  rpc::v1::Status details;
  Pack(TwoViolations(), "BadRequest", &details);
  const absl::Status status = FromGrpc(Refusal("the request is invalid", details));
  EXPECT_THAT(status,
              StatusIs(absl::StatusCode::kInvalidArgument,
                       "the request is invalid: leader.frame_rate_hz: 0, expected 1 to 240; "
                       "label_vector: empty, expected at least one weight"));
  ASSERT_THAT(FieldViolations(status), SizeIs(2));
  EXPECT_EQ(FieldViolations(status)[1].field, "label_vector");
  EXPECT_EQ(FieldViolations(status)[1].description, "empty, expected at least one weight");
}

TEST(FromGrpcTest, ViolationsInTheMessageAreNotRepeated) {
  rpc::v1::Status details;
  Pack(TwoViolations(), "BadRequest", &details);
  const absl::Status status =
      FromGrpc(Refusal("leader.frame_rate_hz: 0, expected 1 to 240; and 1 more", details));
  EXPECT_THAT(status, StatusIs(absl::StatusCode::kInvalidArgument,
                               "leader.frame_rate_hz: 0, expected 1 to 240; and 1 more: "
                               "label_vector: empty, expected at least one weight"));
}

TEST(FromGrpcTest, RetryInfoAndErrorInfoAreReadable) {
  rpc::v1::Status details;
  rpc::v1::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(1);
  retry.mutable_retry_delay()->set_nanos(500'000'000);
  Pack(retry, "RetryInfo", &details);
  rpc::v1::ErrorInfo info;
  info.set_reason("QUEUE_FULL");
  Pack(info, "ErrorInfo", &details);
  const absl::Status status = FromGrpc(Refusal("full", details));
  EXPECT_THAT(RetryDelay(status), Eq(absl::Milliseconds(1500)));
  EXPECT_EQ(ErrorReason(status), "QUEUE_FULL");
  const absl::Status longer = AppendMessage(status, " for now");
  EXPECT_THAT(longer, StatusIs(absl::StatusCode::kInvalidArgument, "full for now"));
  EXPECT_EQ(ErrorReason(longer), "QUEUE_FULL");
}

TEST(FromGrpcTest, MalformedDetailsKeepCodeAndMessage) {
  const grpc::Status refusal(grpc::StatusCode::INVALID_ARGUMENT, "bad", "\xff\xff\xff");
  EXPECT_THAT(FromGrpc(refusal), StatusIs(absl::StatusCode::kInvalidArgument, "bad"));

  rpc::v1::Status details;
  google::protobuf::Any* any = details.add_details();
  any->set_type_url("type.googleapis.com/google.rpc.BadRequest");
  any->set_value("\xff\xff\xff");
  const absl::Status status = FromGrpc(Refusal("bad", details));
  EXPECT_THAT(status, StatusIs(absl::StatusCode::kInvalidArgument, "bad"));
  EXPECT_THAT(FieldViolations(status), IsEmpty());
}

}  // namespace
}  // namespace duet::client::internal
