#ifndef DUET_SERVER_SECURITY_TLS_CERTIFICATES_H_
#define DUET_SERVER_SECURITY_TLS_CERTIFICATES_H_

#include <grpcpp/security/server_credentials.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "server/common/mutex.h"

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

// The certificates for the next handshake. They can be replaced at any time; open connections keep
// theirs.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil's synchronisation.
class TlsCertificates {
 public:
  struct Current {
    std::shared_ptr<const TlsMaterial> material;
    std::uint64_t generation = 0;  // changes with each Replace
  };

  explicit TlsCertificates(TlsMaterial material);

  void Replace(TlsMaterial material);
  Current current() const;

 private:
  mutable common::Mutex mutex_;
  Current current_ DUET_GUARDED_BY(mutex_);
};

// Makes credentials for one listening port. Every handshake reads `certificates`, so that a
// replacement applies from the next connection. Supports TLS 1.2 and 1.3. A client certificate is
// required and verified if the material has client authorities.
//
// `certificates` outlives the server. Call it once for each port. Whether clients need a
// certificate is fixed here: later material may have other client authorities, but must have some
// if and only if this one has.
std::shared_ptr<grpc::ServerCredentials> MakeServerCredentials(const TlsCertificates& certificates);

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_TLS_CERTIFICATES_H_
