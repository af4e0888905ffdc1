#include "server/security/tls_material.h"

#include <openssl/x509.h>

#include <cstddef>
#include <ctime>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "model/base/file.h"
#include "model/base/pem.h"
#include "server/common/join_status.h"

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

}  // namespace duet::server::security
