// The client over TLS: what must connect, and what must not.
#include <memory>
#include <string>

#include "client/client.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/client/support/fake_service.h"
#include "tests/support/matchers.h"
#include "tests/support/test_certificate.h"

namespace duet::client::internal {
namespace {

using test::FakeServer;
using test::kLongestCall;
using test::MakeTestCertificate;
using test::TestCertificate;

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

TEST_F(TlsTest, OnlyATrustedCertificateOfTheNameIsAccepted) {
  StartServer(false);
  EXPECT_THAT(Call(), IsOk());
  options_.tls->server_name = "other.test";
  EXPECT_THAT(Call(), StatusIs(kUnavailable, HasSubstr("")));
  options_.tls->server_name = "duet.test";
  options_.tls->root_certificates = clients_.certificate;
  EXPECT_THAT(Call(), StatusIs(kUnavailable, HasSubstr("")));
}

TEST_F(TlsTest, ClientCertificateIsSentOnRequest) {
  StartServer(true);
  EXPECT_THAT(Call(), StatusIs(kUnavailable, HasSubstr("")));
  options_.tls->certificate_chain = clients_.certificate;
  options_.tls->private_key = clients_.private_key;
  EXPECT_THAT(Call(), IsOk());
}

TEST_F(TlsTest, TokenIsSentEncryptedWithEveryCall) {
  StartServer(false);
  std::string came;
  server_->service().on_list_models = [&](grpc::ServerContext* context, v1::ListModelsResponse*) {
    const auto found = context->client_metadata().find("authorization");
    if (found != context->client_metadata().end()) {
      came = std::string(found->second.data(), found->second.size());
    }
    return grpc::Status::OK;
  };
  EXPECT_THAT(Call(), IsOk());
  EXPECT_EQ(came, "");
  options_.token = "secret-1";
  EXPECT_THAT(Call(), IsOk());
  EXPECT_EQ(came, "Bearer secret-1");
}

TEST_F(TlsTest, AuthorityIsSent) {
  StartServer(false);
  options_.tls->server_name.clear();
  EXPECT_THAT(Call(), StatusIs(kUnavailable, HasSubstr("")));
  options_.authority = "duet.test";
  EXPECT_THAT(Call(), IsOk());
}

TEST(TokenTest, IsSentInPlainTextOnlyToThisMachine) {
  ClientOptions options;
  options.token = "secret-1";
  for (const char* here :
       {"localhost:50051", "127.0.0.1:50051", "127.1.2.3:1", "[::1]:50051", "dns:///localhost:1",
        "dns:localhost:1", "ipv4:127.0.0.1:1", "ipv6:[::1]:1", "unix:/run/duet.sock",
        "unix-abstract:duet", "localhost"}) {
    options.server_address = here;
    EXPECT_THAT(Client::Create(options), IsOk()) << here;
  }
  for (const char* elsewhere :
       {"duet.example:50051", "10.0.0.1:50051", "127.example.com:1", "localhost.example:1",
        "dns://8.8.8.8/localhost:1", "ipv4:127.0.0.1:1,10.0.0.1:1", "[::1].example:1", "[::2]:1",
        "xds:///localhost:1"}) {
    options.server_address = elsewhere;
    EXPECT_THAT(Client::Create(options),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("token: expected TLS to ")))
        << elsewhere;
  }
  options.tls.emplace();
  EXPECT_THAT(Client::Create(options), IsOk());
  for (const char* token : {"two words", "line\nbreak", "\xff"}) {
    options.token = token;
    EXPECT_THAT(Client::Create(options),
                StatusIs(absl::StatusCode::kInvalidArgument,
                         AllOf(HasSubstr("token: "), Not(HasSubstr(token)))));
  }
}

}  // namespace
}  // namespace duet::client::internal
