// The client over TLS: what must connect, and what must not.
#include <memory>

#include "client/client.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/client/support/fake_service.h"
#include "tests/client/support/test_certificate.h"
#include "tests/support/status_matchers.h"

namespace duet::client::internal {
namespace {

using test::FakeServer;
using test::IsOk;
using test::kLongestCall;
using test::MakeTestCertificate;
using test::StatusIs;
using test::TestCertificate;

using ::testing::HasSubstr;

class TlsTest : public ::testing::Test {
 protected:
  void StartServer(bool asks_for_certificates) {
    grpc::SslServerCredentialsOptions options(
        asks_for_certificates ? GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY
                              : GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE);
    options.pem_key_cert_pairs = {{servers_.private_key, servers_.certificate}};
    options.pem_root_certs = clients_.certificate;
    server_ = std::make_unique<FakeServer>(grpc::SslServerCredentials(options));
    server_->service().on_list_models = [](grpc::ServerContext*, v1::ListModelsResponse*) {
      return grpc::Status::OK;
    };
    options_.server_address = server_->address();
    options_.deadline = kLongestCall;
    options_.retry.max_attempts = 1;
    options_.tls.emplace();
    options_.tls->root_certificates = servers_.certificate;
    options_.tls->server_name = "duet.test";
  }

  absl::Status Call() {
    absl::StatusOr<Client> client = Client::Create(options_);
    return client.ok() ? client->ListModels().status() : client.status();
  }

  const TestCertificate servers_ = MakeTestCertificate("duet.test");
  const TestCertificate clients_ = MakeTestCertificate("client.test");
  ClientOptions options_;
  std::unique_ptr<FakeServer> server_;
};

constexpr auto kUnavailable = absl::StatusCode::kUnavailable;

TEST_F(TlsTest, AServerWithATrustedCertificateIsReached) {
  StartServer(false);
  EXPECT_THAT(Call(), IsOk());
}

TEST_F(TlsTest, AnUntrustedCertificateIsRefused) {
  StartServer(false);
  options_.tls->root_certificates = clients_.certificate;
  EXPECT_THAT(Call(), StatusIs(kUnavailable, HasSubstr("")));
}

TEST_F(TlsTest, ACertificateOfAnotherNameIsRefused) {
  StartServer(false);
  options_.tls->server_name = "other.test";
  EXPECT_THAT(Call(), StatusIs(kUnavailable, HasSubstr("")));
}

TEST_F(TlsTest, PlainTextDoesNotReachAServerThatEncrypts) {
  StartServer(false);
  options_.tls.reset();
  EXPECT_THAT(Call(), StatusIs(kUnavailable, HasSubstr("")));
}

TEST_F(TlsTest, AServerThatAsksForACertificateGetsOne) {
  StartServer(true);
  EXPECT_THAT(Call(), StatusIs(kUnavailable, HasSubstr("")));
  options_.tls->certificate_chain = clients_.certificate;
  options_.tls->private_key = clients_.private_key;
  EXPECT_THAT(Call(), IsOk());
}

}  // namespace
}  // namespace duet::client::internal
