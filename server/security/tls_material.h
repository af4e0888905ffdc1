#ifndef DUET_SERVER_SECURITY_TLS_MATERIAL_H_
#define DUET_SERVER_SECURITY_TLS_MATERIAL_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"

namespace duet::server::security {

// What the server shows in a TLS handshake, and whom it believes. PEM text.
struct TlsMaterial {
  std::string certificate_chain;  // the server's own certificate first
  std::string private_key;
  std::string client_authorities;  // who may sign clients' certificates; empty: none are asked for

  bool operator==(const TlsMaterial& other) const {
    return certificate_chain == other.certificate_chain && private_key == other.private_key &&
           client_authorities == other.client_authorities;
  }
};

// Where it is read from. No certificate file: no TLS.
struct TlsFiles {
  std::filesystem::path certificate;
  std::filesystem::path key;
  std::filesystem::path client_ca;  // empty: clients need no certificate
};

// Reads the files as they are. Fails with one line for each that cannot be read: the setting and
// the file.
absl::StatusOr<TlsMaterial> ReadTlsMaterial(const TlsFiles& files);

// Whether a handshake could succeed with it: certificates and key are PEM, the key is the first
// certificate's, which is valid at `now`. Returns until when that certificate is.
// Fails with INVALID_ARGUMENT, one line for each setting that is wrong; never with anything of the
// key.
absl::StatusOr<absl::Time> CheckTlsMaterial(const TlsMaterial& material, absl::Time now);

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_TLS_MATERIAL_H_
