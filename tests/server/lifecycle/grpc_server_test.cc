#include "server/lifecycle/grpc_server.h"

#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "duet/v1/synthesis.grpc.pb.h"
#include "tests/support/matchers.h"

namespace duet::server::lifecycle {
namespace {

// Answers sessions with nothing, until their callers end them.
class SilentService final : public v1::MotionSynthesis::Service {
 public:
  grpc::Status SynthesizeLive(
      grpc::ServerContext*,
      grpc::ServerReaderWriter<v1::SynthesizeLiveResponse, v1::SynthesizeLiveRequest>* stream)
      override {
    v1::SynthesizeLiveRequest message;
    while (stream->Read(&message)) continue;
    return grpc::Status::OK;
  }
};

TEST(GrpcServerTest, SessionsOutlastTheAgeOfTheirConnection) {
  SilentService service;
  GrpcServerOptions options;
  options.listen = {"127.0.0.1", 0};
  options.max_request_bytes = 1 << 20;
  options.max_transport_bytes = std::size_t{64} << 20;
  options.max_calls = 4;
  options.connection_age_seconds = 0.2;
  absl::StatusOr<GrpcServer> server = StartGrpcServer(options, service);
  ASSERT_THAT(server.status(), IsOk());
  const auto channel = grpc::CreateChannel(absl::StrCat("127.0.0.1:", server->port),
                                           grpc::InsecureChannelCredentials());
  const auto stub = v1::MotionSynthesis::NewStub(channel);
  grpc::ClientContext context;
  // With a grace period of a second, gRPC would end the session with UNAVAILABLE before that.
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(3));
  const auto stream = stub->SynthesizeLive(&context);
  v1::SynthesizeLiveResponse message;
  EXPECT_FALSE(stream->Read(&message));
  EXPECT_EQ(stream->Finish().error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  server->server->Shutdown(std::chrono::system_clock::now());
}

}  // namespace
}  // namespace duet::server::lifecycle
