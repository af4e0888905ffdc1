#ifndef DUET_SERVER_LIFECYCLE_SECRET_OPTIONS_H_
#define DUET_SERVER_LIFECYCLE_SECRET_OPTIONS_H_

#include "server/config/server_options.h"
#include "server/security/secret_files.h"

namespace duet::server::lifecycle {

// The files that `options` name, as what keeps them takes them.
inline security::SecretFiles::Options SecretsOf(const config::SecurityOptions& options) {
  security::SecretFiles::Options secrets;
  secrets.tls = {options.tls_certificate_file, options.tls_key_file, options.tls_client_ca_file};
  secrets.access = options.access_file;
  return secrets;
}

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_SECRET_OPTIONS_H_
