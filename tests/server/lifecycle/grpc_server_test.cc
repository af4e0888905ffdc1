#include "server/lifecycle/grpc_server.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <string>

#include "absl/strings/str_cat.h"
#include "duet/v1/synthesis.grpc.pb.h"
#include "tests/server/support/running_service.h"
#include "tests/support/matchers.h"

namespace duet::server::lifecycle {
namespace {

using absl::StatusCode;

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

// A listening socket on this machine. The test decides whether to accept.
class Listener {
 public:
  Listener() : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    EXPECT_EQ(listen(socket_, 4), 0);
    socklen_t size = sizeof(address);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~Listener() { Close(); }
  void Close() {
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
  }
  int Accept() const { return accept(socket_, nullptr, nullptr); }
  int port() const { return port_; }

 private:
  int socket_;
  int port_ = 0;
};

TEST(CheckListenerTest, AnsweringServerPasses) {
  test::RunningService running;
  const std::string address = running.address();
  const int port = std::stoi(address.substr(address.rfind(':') + 1));
  EXPECT_THAT(CheckListener("127.0.0.1", port, 60), IsOk());
  EXPECT_THAT(CheckListener("0.0.0.0", port, 60), IsOk()) << "every interface, this machine's too";
}

// Like gRPC's listener after it has run out of descriptors.
TEST(CheckListenerTest, ListenerThatDoesNotAcceptFails) {
  const Listener listener;
  EXPECT_THAT(CheckListener("127.0.0.1", listener.port(), 0.05),
              StatusIs(StatusCode::kUnavailable, HasSubstr("connected, but got no answer")));
}

TEST(CheckListenerTest, ErrorNamesAPortWithoutAListener) {
  Listener listener;
  listener.Close();
  EXPECT_THAT(CheckListener("127.0.0.1", listener.port(), 60),
              StatusIs(StatusCode::kUnavailable, HasSubstr("cannot connect")));
}

}  // namespace
}  // namespace duet::server::lifecycle
