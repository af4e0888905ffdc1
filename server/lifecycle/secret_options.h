#ifndef DUET_SERVER_LIFECYCLE_SECRET_OPTIONS_H_
#define DUET_SERVER_LIFECYCLE_SECRET_OPTIONS_H_

#include "duet/v1/server_config.pb.h"
#include "server/security/secret_files.h"

namespace duet::server::lifecycle {

// Returns the files of secrets that the settings name.
inline security::SecretFiles::Options SecretsOf(const v1::ServerConfig& settings) {
  security::SecretFiles::Options secrets;
  secrets.tls = {settings.tls_certificate_file(), settings.tls_key_file(),
                 settings.tls_client_ca_file()};
  secrets.access = settings.access_file();
  return secrets;
}

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_SECRET_OPTIONS_H_
