#ifndef DUET_SERVER_SECURITY_SERVER_CREDENTIALS_H_
#define DUET_SERVER_SECURITY_SERVER_CREDENTIALS_H_

#include <grpcpp/security/server_credentials.h>

#include <memory>

#include "server/security/tls_certificates.h"

namespace duet::server::security {

// Credentials of one listening port that asks `certificates` at every handshake, so that a
// replacement counts from the next connection on. TLS 1.2 and 1.3; a client's certificate is
// required, and verified, where the material names authorities for it.
//
// `certificates` outlives the server. Call once for each port. Whether clients need a certificate
// is settled here: later material may name other authorities, but not begin or cease to name any.
std::shared_ptr<grpc::ServerCredentials> MakeServerCredentials(const TlsCertificates& certificates);

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_SERVER_CREDENTIALS_H_
