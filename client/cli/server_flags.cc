#include "client/cli/server_flags.h"

#include "client/cli/flags.h"

namespace duet::client::cli {

void AddServerFlags(CLI::App* app, ServerArguments* server) {
  app->add_option("--server", server->address,
                  "Server, or any gRPC target such as unix:/run/duet.sock")
      ->capture_default_str()
      ->type_name("HOST:PORT")
      ->group(kServerGroup);
  app->add_option("--wait", server->wait_seconds,
                  "Seconds to retry a server that cannot be reached; at most --timeout")
      ->check(Undescribed(CLI::Range(0.0, 86400.0)))
      ->capture_default_str()
      ->type_name("SECONDS")
      ->group(kServerGroup);
  AddConnectionFlags(app, server);
}

void AddConnectionFlags(CLI::App* app, ServerArguments* server) {
  app->add_option("--timeout", server->timeout_seconds, "Deadline of the whole call, with retries")
      ->check(Undescribed(CLI::Range(0.001, 86400.0)))
      ->capture_default_str()
      ->type_name("SECONDS")
      ->group(kServerGroup);
  AddCredentialFlags(app, server);
}

void AddCredentialFlags(CLI::App* app, ServerArguments* server) {
  app->add_flag("--tls", server->tls, "Encrypt; trust the certificate authorities of the system")
      ->group(kServerGroup);
  app->add_option("--tls-ca", server->tls_ca_file,
                  "Encrypt; trust the certificate authorities in this file")
      ->type_name("FILE")
      ->group(kServerGroup);
  CLI::Option* certificate =
      app->add_option("--tls-cert", server->tls_certificate_file, "Certificate of this client")
          ->type_name("FILE")
          ->group(kServerGroup);
  CLI::Option* key =
      app->add_option("--tls-key", server->tls_key_file, "Private key of this client")
          ->type_name("FILE")
          ->group(kServerGroup);
  certificate->needs(key);
  key->needs(certificate);
  app->add_option("--tls-server-name", server->tls_server_name,
                  "Name in the server's certificate, if it differs from the address")
      ->type_name("NAME")
      ->group(kServerGroup);
  app->add_option("--token-file", server->token_file,
                  "Token that identifies the caller; only sent encrypted or to this machine")
      ->type_name("FILE")
      ->group(kServerGroup);
  app->add_option("--authority", server->authority,
                  "Name of the server that a proxy routes by, if it differs from the address")
      ->type_name("NAME")
      ->group(kServerGroup);
}

}  // namespace duet::client::cli
