#ifndef DUET_SERVER_SECURITY_TLS_MATERIAL_H_
#define DUET_SERVER_SECURITY_TLS_MATERIAL_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"

namespace duet::server::security {

// The server's certificate and key, and the authorities that it trusts. PEM text.
struct TlsMaterial {
  std::string certificate_chain;  // the server's own certificate first
  std::string private_key;
  std::string client_authorities;  // sign client certificates; empty: clients need none

  bool operator==(const TlsMaterial& other) const {
    return certificate_chain == other.certificate_chain && private_key == other.private_key &&
           client_authorities == other.client_authorities;
  }
};

// The files of TlsMaterial. No certificate file: no TLS.
struct TlsFiles {
  std::filesystem::path certificate;
  std::filesystem::path key;
  std::filesystem::path client_ca;  // empty: clients need no certificate
};

// Reads the files without checking their content. Fails with one line for each file that cannot be
// read: the setting and the file.
absl::StatusOr<TlsMaterial> ReadTlsMaterial(const TlsFiles& files);

// Checks that a handshake can succeed: certificates and key are PEM, the key belongs to the first
// certificate, and that certificate is valid at `now`. Returns the end of its validity.
// Fails with INVALID_ARGUMENT and one line for each wrong setting; never with any part of the key.
absl::StatusOr<absl::Time> CheckTlsMaterial(const TlsMaterial& material, absl::Time now);

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_TLS_MATERIAL_H_
