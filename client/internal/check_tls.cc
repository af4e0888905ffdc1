#include "client/internal/check_tls.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/pem.h"

namespace duet::client::internal {
namespace {

absl::Status Wrong(const std::string& name, absl::string_view expected, absl::string_view got) {
  return absl::InvalidArgumentError(absl::StrCat(name, ": expected ", expected, ", got ", got));
}

absl::Status CheckOwnCertificate(const TlsOptions& tls, const TlsNames& names) {
  const std::vector<base::Certificate> chain = base::ReadCertificates(tls.certificate_chain);
  if (chain.empty()) {
    return Wrong(names.certificate_chain, "PEM certificates, this client's own first", "none");
  }
  const base::PrivateKey key = base::ReadPrivateKey(tls.private_key);
  if (key == nullptr) {
    return Wrong(names.private_key, "a private key in PEM without a password", "none");
  }
  if (base::IsKeyOf(chain.front(), key)) return absl::OkStatus();
  return Wrong(names.private_key,
               absl::StrCat("the key of the first certificate in ", names.certificate_chain),
               "another certificate's key");
}

}  // namespace

absl::Status CheckTls(const TlsOptions& tls, const TlsNames& names) {
  if (tls.certificate_chain.empty() != tls.private_key.empty()) {
    return absl::InvalidArgumentError(
        "tls: expected certificate_chain and private_key or neither, got one of the two");
  }
  if (!tls.root_certificates.empty() && base::ReadCertificates(tls.root_certificates).empty()) {
    return Wrong(names.root_certificates, "PEM certificates", "none");
  }
  return tls.certificate_chain.empty() ? absl::OkStatus() : CheckOwnCertificate(tls, names);
}

}  // namespace duet::client::internal
