#include "server/security/tls_certificates.h"

#include <grpc/grpc.h>
#include <grpc/grpc_security.h>
#include <openssl/x509.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "model/base/file.h"
#include "model/base/pem.h"
#include "server/common/error_details.h"

namespace duet::server::security {
namespace {

// A bundle of all public authorities has about 200 kB; a far larger file is a mistake.
constexpr std::size_t kMaxPemBytes = std::size_t{1} << 20;

absl::Time ToTime(const ASN1_TIME* time) {
  std::tm fields = {};
  return ASN1_TIME_to_tm(time, &fields) == 1 ? absl::FromTimeT(timegm(&fields))
                                             : absl::InfinitePast();
}

absl::Status ReadPem(absl::string_view setting, const std::filesystem::path& path,
                     std::string* pem) {
  if (path.empty()) return absl::OkStatus();
  absl::StatusOr<std::string> text = base::ReadFile(path, kMaxPemBytes, "a PEM file");
  if (!text.ok()) {
    return absl::Status(text.status().code(), absl::StrCat(setting, ": ", text.status().message()));
  }
  *pem = *std::move(text);
  return absl::OkStatus();
}

absl::Status CheckChain(const std::vector<base::Certificate>& chain, absl::Time now) {
  if (chain.empty()) {
    return absl::InvalidArgumentError(
        "tls_certificate_file: expected PEM, the server's own certificate first, got none");
  }
  const absl::Time from = ToTime(X509_get0_notBefore(chain.front().get()));
  const absl::Time until = ToTime(X509_get0_notAfter(chain.front().get()));
  if (from <= now && now <= until) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("tls_certificate_file: expected a certificate that is valid now, got one valid "
                   "from ",
                   absl::FormatTime(from), " to ", absl::FormatTime(until)));
}

absl::Status CheckKey(const std::vector<base::Certificate>& chain, const base::PrivateKey& key) {
  if (key == nullptr) {
    return absl::InvalidArgumentError(
        "tls_key_file: expected a private key in PEM without a password, got none");
  }
  if (chain.empty() || base::IsKeyOf(chain.front(), key)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "tls_key_file: expected the key of the first certificate in tls_certificate_file, got "
      "another certificate's key");
}

absl::Status CheckAuthorities(const std::string& pem) {
  if (pem.empty() || !base::ReadCertificates(pem).empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "tls_client_ca_file: expected PEM certificates of those who sign clients', got none");
}

// The C++ interface of gRPC 1.51 takes certificates once, or makes gRPC watch their files, which
// leaves a server without a certificate while certificate and key do not match. The C interface
// calls back at each connection and keeps the last certificates that worked.
class RotatingCredentials final : public grpc::ServerCredentials {
 public:
  explicit RotatingCredentials(const TlsCertificates& certificates) : certificates_(certificates) {
    const bool mutual = !certificates.current().material->client_authorities.empty();
    credentials_ = grpc_ssl_server_credentials_create_with_options(
        grpc_ssl_server_credentials_create_options_using_config_fetcher(
            mutual ? GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY
                   : GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE,
            Fetch, this));
  }
  ~RotatingCredentials() override { grpc_server_credentials_release(credentials_); }

  void SetAuthMetadataProcessor(const std::shared_ptr<grpc::AuthMetadataProcessor>&) override {}

 private:
  int AddPortToServer(const std::string& address, grpc_server* server) override {
    return grpc_server_add_http2_port(server, address.c_str(), credentials_);
  }

  static grpc_ssl_certificate_config_reload_status Fetch(
      void* self, grpc_ssl_server_certificate_config** config) {
    return static_cast<RotatingCredentials*>(self)->Fetch(config);
  }

  grpc_ssl_certificate_config_reload_status Fetch(grpc_ssl_server_certificate_config** config) {
    const TlsCertificates::Current current = certificates_.current();
    if (given_.exchange(current.generation) == current.generation) {
      return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_UNCHANGED;
    }
    const TlsMaterial& material = *current.material;
    const grpc_ssl_pem_key_cert_pair pair = {material.private_key.c_str(),
                                             material.certificate_chain.c_str()};
    // The library requires authorities even if clients need no certificate; any PEM will do then.
    const std::string& authorities = material.client_authorities.empty()
                                         ? material.certificate_chain
                                         : material.client_authorities;
    *config = grpc_ssl_server_certificate_config_create(authorities.c_str(), &pair, 1);
    return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_NEW;
  }

  const TlsCertificates& certificates_;
  std::atomic<std::uint64_t> given_{0};  // the generation that gRPC has; the first is 1
  grpc_server_credentials* credentials_ = nullptr;
};

}  // namespace

absl::StatusOr<TlsMaterial> ReadTlsMaterial(const TlsFiles& files) {
  TlsMaterial material;
  const absl::Status status =
      common::Join({ReadPem("tls_certificate_file", files.certificate, &material.certificate_chain),
                    ReadPem("tls_key_file", files.key, &material.private_key),
                    ReadPem("tls_client_ca_file", files.client_ca, &material.client_authorities)});
  if (!status.ok()) return status;
  if (!files.client_ca.empty() && material.client_authorities.empty()) {
    // Empty authorities would mean that clients need no certificate.
    return absl::InvalidArgumentError(
        "tls_client_ca_file: expected PEM certificates, got an empty file");
  }
  return material;
}

absl::StatusOr<absl::Time> CheckTlsMaterial(const TlsMaterial& material, absl::Time now) {
  const std::vector<base::Certificate> chain = base::ReadCertificates(material.certificate_chain);
  const base::PrivateKey key = base::ReadPrivateKey(material.private_key);
  const absl::Status status = common::Join({CheckChain(chain, now), CheckKey(chain, key),
                                            CheckAuthorities(material.client_authorities)});
  if (!status.ok()) return status;
  return ToTime(X509_get0_notAfter(chain.front().get()));
}

TlsCertificates::TlsCertificates(TlsMaterial material) { Replace(std::move(material)); }

void TlsCertificates::Replace(TlsMaterial material) {
  auto next = std::make_shared<const TlsMaterial>(std::move(material));
  common::MutexLock lock(mutex_);
  current_ = {std::move(next), current_.generation + 1};
}

TlsCertificates::Current TlsCertificates::current() const {
  common::MutexLock lock(mutex_);
  return current_;
}

std::shared_ptr<grpc::ServerCredentials> MakeServerCredentials(
    const TlsCertificates& certificates) {
  return std::make_shared<RotatingCredentials>(certificates);
}

}  // namespace duet::server::security
