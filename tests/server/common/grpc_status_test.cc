#include <gmock/gmock.h>
#include <grpcpp/server_context.h>
#include <grpcpp/test/server_context_test_spouse.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "absl/time/time.h"
#include "server/common/error_details.h"
#include "tests/server/support/refusal.h"
#include "tests/support/matchers.h"

namespace duet::server::common {
namespace {

using test::Decode;
using test::Refusal;

TEST(ToGrpcStatusTest, KeepsEveryCode) {
  for (int code = 0; code <= 16; ++code) {
    const std::string why = code == 0 ? "" : "why";
    const grpc::Status status =
        ToGrpcStatus(absl::Status(static_cast<absl::StatusCode>(code), why));
    EXPECT_EQ(status.error_code(), code);
    EXPECT_EQ(status.error_message(), why);
    EXPECT_EQ(status.error_details(), "") << "nothing to tell beyond code and message";
  }
}

TEST(ToGrpcStatusTest, CarriesEveryDetail) {
  absl::Status status = absl::UnavailableError("later");
  AddBadRequest(status, {{"a.b[0]", "is 1"}, {"c", "is 2"}});
  status = WithInfo(status, kReasonDraining, {{"key", "value"}});
  AddRetryInfo(status, absl::Milliseconds(1500));
  const Refusal refusal = Decode(ToGrpcStatus(status));
  EXPECT_EQ(refusal.code, absl::StatusCode::kUnavailable);
  EXPECT_EQ(refusal.message, "later");
  EXPECT_EQ(refusal.Of("a.b[0]"), "is 1");
  EXPECT_EQ(refusal.Of("c"), "is 2");
  EXPECT_EQ(refusal.reason, "SERVER_DRAINING");
  EXPECT_EQ(refusal.metadata.at("key"), "value");
  EXPECT_DOUBLE_EQ(refusal.retry_seconds, 1.5);
}

// The same bytes as google.rpc's own protos, so that any client decodes them:
// Status{code: 3, message: "m", details: [Any{type_url, BadRequest{[{field: "f",
// description: "d"}]}}]}.
TEST(ToGrpcStatusTest, DetailsHaveTheWireFormatOfGoogleRpc) {
  absl::Status status = absl::InvalidArgumentError("m");
  AddBadRequest(status, {{"f", "d"}});
  const std::string url = "type.googleapis.com/google.rpc.BadRequest";
  const std::string bad_request =
      "\x0a\x06\x0a\x01"
      "f"
      "\x12\x01"
      "d";
  const std::string any = "\x0a" + std::string(1, static_cast<char>(url.size())) + url + "\x12" +
                          std::string(1, static_cast<char>(bad_request.size())) + bad_request;
  EXPECT_EQ(ToGrpcStatus(status).error_details(),
            "\x08\x03\x12\x01m\x1a" + std::string(1, static_cast<char>(any.size())) + any);
}

TEST(AddRetryPushbackTest, SendsTheDelayInMillisecondsIfThereIsOne) {
  for (const auto& [delay, trailer] : {std::pair{absl::Seconds(3), "3000"},
                                       {absl::Milliseconds(250), "250"},
                                       {absl::Milliseconds(1500), "1500"}}) {
    absl::Status status = absl::UnavailableError("later");
    grpc::ServerContext context;
    AddRetryPushback(status, context);
    const grpc::testing::ServerContextTestSpouse seen(&context);
    EXPECT_TRUE(seen.GetTrailingMetadata().empty());
    AddRetryInfo(status, delay);
    AddRetryPushback(status, context);
    EXPECT_THAT(seen.GetTrailingMetadata(), ElementsAre(Pair("grpc-retry-pushback-ms", trailer)));
  }
}

}  // namespace
}  // namespace duet::server::common
