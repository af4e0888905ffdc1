#ifndef DUET_SERVER_SECURITY_SERVER_CREDENTIALS_H_
#define DUET_SERVER_SECURITY_SERVER_CREDENTIALS_H_

#include <grpcpp/security/server_credentials.h>

#include <memory>

#include "server/security/tls_certificates.h"

namespace duet::server::security {

// Makes credentials for one listening port. Every handshake reads `certificates`, so that a
// replacement applies from the next connection. Supports TLS 1.2 and 1.3. A client certificate is
// required and verified if the material has client authorities.
//
// `certificates` outlives the server. Call it once for each port. Whether clients need a
// certificate is fixed here: later material may have other client authorities, but must have some
// if and only if this one has.
std::shared_ptr<grpc::ServerCredentials> MakeServerCredentials(const TlsCertificates& certificates);

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_SERVER_CREDENTIALS_H_
