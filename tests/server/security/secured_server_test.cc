// The whole server behind certificates and an access file, over the wire.

#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "duet/v1/synthesis.grpc.pb.h"
#include "model/base/sha256.h"
#include "server/config/settings.h"
#include "server/lifecycle/duet_server.h"
#include "tests/server/support/fakes.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_certificate.h"

namespace duet::server::security {
namespace {

using grpc::StatusCode;
using test::Call;
using test::Decode;
using test::FakeSynthesizer;
using test::GatedModel;
using test::Health;
using test::HttpGet;
using test::MakeTestCertificate;
using test::Refusal;
using test::SampleRequest;
using test::TemporaryFolder;
using test::TestCertificate;
using test::TimedContext;
using test::WriteTestFile;

constexpr int kFrames = 40;  // of a sample request

class NoLog final : public metrics::LogSink {
 public:
  bool Write(std::string_view) override { return true; }
};

class SecuredServerTest : public ::testing::Test {
 protected:
  SecuredServerTest() {
    options_.set_listen("127.0.0.1:0");
    options_.set_metrics_listen("127.0.0.1:0");
  }

  void UseTls() {
    options_.set_tls_certificate_file((folder_ / "cert.pem").string());
    options_.set_tls_key_file((folder_ / "key.pem").string());
    ShowCertificate(MakeTestCertificate("duet.test", {&authority_}));
  }
  void ShowCertificate(const TestCertificate& certificate) {
    WriteTestFile(folder_ / "cert.pem", certificate.certificate);
    WriteTestFile(folder_ / "key.pem", certificate.private_key);
  }
  void AskForClientCertificates() {
    options_.set_tls_client_ca_file((folder_ / "ca.pem").string());
    WriteTestFile(folder_ / "ca.pem", authority_.certificate);
  }
  void UseAccess(const std::string& text) {
    options_.set_access_file((folder_ / "access").string());
    WriteTestFile(folder_ / "access", text);
  }
  // "sha256:..." of a token.
  static std::string Known(const std::string& token) {
    return absl::StrCat("sha256:", base::Sha256Hex(token));
  }

  void Start(
      std::shared_ptr<const engine::Synthesizer> model = std::make_shared<FakeSynthesizer>()) {
    auto started = lifecycle::DuetServer::Start(options_, log_);
    ASSERT_THAT(started, IsOk());
    server_ = *std::move(started);
    server_->Add({"fake/1", std::move(model), 0.5});
    ASSERT_THAT(server_->Serve(), IsOk());
  }

  // A connection of its own each time, so that every one shakes hands.
  std::shared_ptr<grpc::Channel> Connect(
      const std::shared_ptr<grpc::ChannelCredentials>& credentials) {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    if (!options_.tls_certificate_file().empty()) {
      arguments.SetSslTargetNameOverride("duet.test");
    }
    return grpc::CreateCustomChannel(absl::StrCat("127.0.0.1:", server_->port()), credentials,
                                     arguments);
  }
  std::shared_ptr<grpc::Channel> PlainText() { return Connect(grpc::InsecureChannelCredentials()); }
  std::shared_ptr<grpc::Channel> Tls(const TestCertificate& client = {}) {
    return Connect(
        grpc::SslCredentials({authority_.certificate, client.private_key, client.certificate}));
  }
  static grpc::Status List(const std::shared_ptr<grpc::Channel>& channel,
                           const std::string& authorization = "") {
    TimedContext context;
    if (!authorization.empty()) context.AddMetadata("authorization", authorization);
    v1::ListModelsResponse response;
    return v1::MotionSynthesis::NewStub(channel)->ListModels(&context, v1::ListModelsRequest(),
                                                             &response);
  }

  const TemporaryFolder folder_;
  const TestCertificate authority_ = MakeTestCertificate("authority.test");
  v1::ServerConfig options_ = config::ReadSettings(v1::ServerConfig(), /*cores=*/1).values;
  NoLog log_;
  std::unique_ptr<lifecycle::DuetServer> server_;
};

TEST_F(SecuredServerTest, CallsWithoutAValidTokenAreRejectedWithoutASecret) {
  UseAccess("studio synthesise " + Known("secret-1"));
  Start();
  const Refusal missing = Decode(List(PlainText()));
  EXPECT_EQ(missing.code, absl::StatusCode::kUnauthenticated);
  EXPECT_EQ(missing.reason, "CREDENTIALS_MISSING");
  for (const char* wrong : {"Bearer secret-2", "Bearer ", "Basic c2VjcmV0LTE=", "secret-1"}) {
    const Refusal refusal = Decode(List(PlainText(), wrong));
    EXPECT_EQ(refusal.code, absl::StatusCode::kUnauthenticated) << wrong;
    EXPECT_EQ(refusal.reason, "CREDENTIALS_INVALID") << wrong;
    EXPECT_THAT(refusal.message, Not(HasSubstr("secret"))) << wrong;
    EXPECT_THAT(refusal.message, Not(HasSubstr("studio"))) << wrong;
  }
  EXPECT_THAT(HttpGet(server_->metrics_port(), "/metrics"),
              HasSubstr(R"(duet_refusals_total{reason="CREDENTIALS_INVALID"} 4)"));
}

TEST_F(SecuredServerTest, EveryMethodNeedsATokenAndHealthNone) {
  UseAccess("studio synthesise " + Known("secret-1"));
  Start();
  const auto stub = v1::MotionSynthesis::NewStub(PlainText());
  EXPECT_EQ(Call(*stub, SampleRequest(kFrames)).status.error_code(), StatusCode::UNAUTHENTICATED);
  TimedContext context;
  v1::GetModelResponse model;
  EXPECT_EQ(stub->GetModel(&context, v1::GetModelRequest(), &model).error_code(),
            StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(Health(PlainText(), ""), "SERVING");
}

TEST_F(SecuredServerTest, PlacesAreSharedByCallerNotByAddress) {
  UseAccess(
      absl::StrCat("studio synthesise ", Known("s"), "\n", "farm synthesise ", Known("f"), "\n"));
  options_.set_max_calls(4);
  options_.set_client_share(0.5);  // alone, a client comes to hold two of four
  options_.set_workers(4);
  options_.set_max_batch_windows(1);
  GatedModel model;
  Start(model.get());
  const auto call = [this](const std::string& token) {
    TimedContext context;
    context.AddMetadata("authorization", "Bearer " + token);
    return Call(*v1::MotionSynthesis::NewStub(PlainText()), SampleRequest(kFrames), context).status;
  };
  std::vector<std::thread> held;
  std::atomic<int> answered{0};
  const auto hold = [&](const std::string& token, int started) {
    held.emplace_back([&, token] { answered += call(token).ok() ? 1 : 0; });
    model.WaitUntilStarted(started);
  };
  hold("s", 1);
  hold("s", 2);
  EXPECT_EQ(call("s").error_code(), StatusCode::RESOURCE_EXHAUSTED);
  hold("f", 3);  // from the same address
  model.Open();
  for (std::thread& thread : held) thread.join();
  EXPECT_EQ(answered.load(), 3);
}

TEST_F(SecuredServerTest, ClientAuthoritiesRotate) {
  UseTls();
  AskForClientCertificates();
  Start();
  const TestCertificate next = MakeTestCertificate("next.test");
  const TestCertificate client = MakeTestCertificate("client.test", {&next});
  EXPECT_EQ(List(Tls(client)).error_code(), StatusCode::UNAVAILABLE);
  WriteTestFile(folder_ / "ca.pem", next.certificate);
  std::promise<void> reloaded;
  server_->control().Reload([&](const auto&) { reloaded.set_value(); });
  reloaded.get_future().wait();
  EXPECT_TRUE(List(Tls(client)).ok());
  EXPECT_EQ(List(Tls(MakeTestCertificate("client.test", {&authority_}))).error_code(),
            StatusCode::UNAVAILABLE);
}

}  // namespace
}  // namespace duet::server::security
