// The client over a real connection to an in-process server.
#include <atomic>
#include <string>
#include <utility>
#include <vector>

#include "absl/synchronization/notification.h"
#include "client/client.h"
#include "client/internal/connect.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/client/support/fake_service.h"
#include "tests/client/support/replies.h"
#include "tests/support/matchers.h"

namespace duet::client::internal {
namespace {

using test::FakeServer;
using test::FollowerFor;
using test::kLongestCall;
using test::ReplyFor;
using test::ThreeJointLeader;

using Writer = grpc::ServerWriter<v1::SynthesizeResponse>;

grpc::Status WriteAll(const std::vector<v1::SynthesizeResponse>& responses, Writer* writer) {
  for (const v1::SynthesizeResponse& response : responses) writer->Write(response);
  return grpc::Status::OK;
}

class GrpcClientTest : public ::testing::Test {
 protected:
  GrpcClientTest() {
    request_.leader = ThreeJointLeader(5);
    request_.weights = {{"kick", 1}};
    options_.server_address = server_.address();
    options_.deadline = kLongestCall;
    // Retries without noticeable waits.
    options_.retry.initial_backoff = absl::Milliseconds(1);
    options_.retry.max_backoff = absl::Milliseconds(2);
  }

  absl::StatusOr<SynthesisResult> Synthesize() {
    absl::StatusOr<Client> client = Client::Create(options_);
    return client.ok() ? client->Synthesize(request_) : client.status();
  }

  absl::Notification finished_;  // outlives the server, whose handlers may wait for it
  FakeServer server_;
  ClientOptions options_;
  SynthesisRequest request_;
};

TEST_F(GrpcClientTest, SynthesizesOverTheWire) {
  std::string request_id;
  server_.service().on_synthesize = [&](grpc::ServerContext* context,
                                        const v1::SynthesizeRequest& request, Writer* writer) {
    const auto found = context->client_metadata().find("x-request-id");
    request_id = std::string(found->second.begin(), found->second.end());
    EXPECT_EQ(request.leader().frame_count(), 5u);
    return WriteAll(ReplyFor(request_.leader, 2), writer);
  };
  request_.request_id = "job-7";
  const absl::StatusOr<SynthesisResult> result = Synthesize();
  ASSERT_THAT(result, IsOk());
  EXPECT_EQ(result->pair.follower.poses, FollowerFor(request_.leader));
  EXPECT_EQ(request_id, "job-7");
}

TEST_F(GrpcClientTest, DeadlineEndsACall) {
  server_.service().on_synthesize = [&](grpc::ServerContext*, const v1::SynthesizeRequest&,
                                        Writer*) {
    const bool ended = finished_.WaitForNotificationWithTimeout(kLongestCall);
    return grpc::Status(grpc::StatusCode::INTERNAL, ended ? "too late" : "no deadline came");
  };
  options_.deadline = absl::Milliseconds(50);
  EXPECT_THAT(Synthesize().status(), StatusIs(absl::StatusCode::kDeadlineExceeded, HasSubstr("")));
  finished_.Notify();
}

TEST_F(GrpcClientTest, ServerThatReportsNotServingGetsNoCalls) {
  server_.service().on_list_models = [](grpc::ServerContext*, v1::ListModelsResponse*) {
    ADD_FAILURE() << "a call reached a server that does not serve";
    return grpc::Status::OK;
  };
  server_.SetServing(false);
  options_.retry.max_attempts = 4;
  absl::StatusOr<Client> client = Client::Create(options_);
  ASSERT_THAT(client, IsOk());
  EXPECT_THAT(client->ListModels(),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("after 4 attempts")));
}

TEST_F(GrpcClientTest, MissingServerIsReportedWithItsAddressAfterTheWait) {
  options_.server_address = "127.0.0.1:1";
  options_.wait = absl::Milliseconds(50);
  EXPECT_THAT(Synthesize(), StatusIs(absl::StatusCode::kUnavailable,
                                     HasSubstr("the server at 127.0.0.1:1 is not running: ")));
}

TEST_F(GrpcClientTest, EachAsynchronousCallEndsOnce) {
  constexpr int kCalls = 20;
  std::atomic<int> arrived{0};
  server_.service().on_synthesize = [&](grpc::ServerContext*, const v1::SynthesizeRequest& request,
                                        Writer* writer) {
    // The last one is there before the first is answered: they do not wait for one another.
    if (++arrived == 4) finished_.Notify();
    finished_.WaitForNotification();
    if (request.seed() % 2 == 1) return grpc::Status(grpc::StatusCode::UNAVAILABLE, "odd");
    return WriteAll(ReplyFor(request_.leader, 2), writer);
  };
  std::atomic<int> answered{0}, refused{0};
  {
    const absl::StatusOr<Client> client = Client::Create(options_);
    ASSERT_THAT(client, IsOk());
    for (uint64_t seed = 0; seed < kCalls; ++seed) {
      request_.seed = seed;
      client->SynthesizeAsync(request_, [&, seed](const absl::StatusOr<SynthesisResult>& result) {
        EXPECT_EQ(result.ok(), seed % 2 == 0);
        ++(result.ok() ? answered : refused);
      });
    }
  }  // waits for them
  EXPECT_EQ(answered, kCalls / 2);
  EXPECT_EQ(refused, kCalls / 2);
}

TEST(GrpcTargetTest, HostsAreResolvedToEveryServerBehindThem) {
  EXPECT_EQ(GrpcTarget("duet.example.com:50051"), "dns:///duet.example.com:50051");
  EXPECT_EQ(GrpcTarget("[::1]:50051"), "dns:///[::1]:50051");
  EXPECT_EQ(GrpcTarget("unix:/run/duet.sock"), "unix:/run/duet.sock");
  EXPECT_EQ(GrpcTarget("ipv4:10.0.0.1:50051"), "ipv4:10.0.0.1:50051");
  EXPECT_EQ(GrpcTarget("dns://8.8.8.8/duet:1"), "dns://8.8.8.8/duet:1");
}

TEST(ClientCreateTest, InvalidOptionsAreRejected) {
  const struct {
    const char* message;
    void (*spoil)(ClientOptions*);
  } cases[] = {
      {"server_address: expected host:port", [](ClientOptions* o) { o->server_address = ""; }},
      {"deadline: expected more than 0, got 0",
       [](ClientOptions* o) { o->deadline = absl::ZeroDuration(); }},
      {"wait: expected 0 or more, got -1s", [](ClientOptions* o) { o->wait = -absl::Seconds(1); }},
      {"retry.max_attempts: expected 1 or more, got 0",
       [](ClientOptions* o) { o->retry.max_attempts = 0; }},
      {"initial_backoff 100ms and max_backoff 1ms",
       [](ClientOptions* o) { o->retry.max_backoff = absl::Milliseconds(1); }},
      {"certificate_chain and private_key",
       [](ClientOptions* o) { o->tls.emplace().private_key = "key"; }}};
  for (const auto& [message, spoil] : cases) {
    ClientOptions options;
    spoil(&options);
    EXPECT_THAT(Client::Create(options),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(message)));
  }
}

}  // namespace
}  // namespace duet::client::internal
