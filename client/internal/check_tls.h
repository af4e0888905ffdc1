#ifndef DUET_CLIENT_INTERNAL_CHECK_TLS_H_
#define DUET_CLIENT_INTERNAL_CHECK_TLS_H_

#include <string>

#include "absl/status/status.h"
#include "client/options.h"

namespace duet::client::internal {

// What errors call the fields of TlsOptions.
struct TlsNames {
  std::string root_certificates = "tls.root_certificates";
  std::string certificate_chain = "tls.certificate_chain";
  std::string private_key = "tls.private_key";
};

// Checks what gRPC does not: with text that is no PEM, it makes a channel that has no address to
// call, as if there were no server. INVALID_ARGUMENT, never with any part of the key.
absl::Status CheckTls(const TlsOptions& tls, const TlsNames& names = {});

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_CHECK_TLS_H_
