#include "client/cli/server_flags.h"

#include "client/cli/flags.h"

namespace duet::client::cli {

void AddServerFlags(FlagSet* app, ServerArguments* server) {
  app->Add("--server", &server->address, "Server, or any gRPC target such as unix:/run/duet.sock")
      ->ShowDefault()
      ->Form("HOST:PORT")
      ->Group(kServerGroup);
  app->Add("--wait", &server->wait_seconds,
           "Seconds to retry a server that cannot be reached; at most --timeout")
      ->InRange(0.0, 86400.0)
      ->ShowDefault()
      ->Form("SECONDS")
      ->Group(kServerGroup);
  AddConnectionFlags(app, server);
}

void AddConnectionFlags(FlagSet* app, ServerArguments* server) {
  app->Add("--timeout", &server->timeout_seconds, "Deadline of the whole call, with retries")
      ->InRange(0.001, 86400.0)
      ->ShowDefault()
      ->Form("SECONDS")
      ->Group(kServerGroup);
  AddCredentialFlags(app, server);
}

void AddCredentialFlags(FlagSet* app, ServerArguments* server) {
  app->AddSwitch("--tls", &server->tls, "Encrypt; trust the certificate authorities of the system")
      ->Group(kServerGroup);
  app->Add("--tls-ca", &server->tls_ca_file,
           "Encrypt; trust the certificate authorities in this file")
      ->Form("FILE")
      ->Group(kServerGroup);
  Flag* certificate =
      app->Add("--tls-cert", &server->tls_certificate_file, "Certificate of this client")
          ->Form("FILE")
          ->Group(kServerGroup);
  Flag* key = app->Add("--tls-key", &server->tls_key_file, "Private key of this client")
                  ->Form("FILE")
                  ->Group(kServerGroup);
  certificate->Needs(key);
  key->Needs(certificate);
  app->Add("--tls-server-name", &server->tls_server_name,
           "Name in the server's certificate, if it differs from the address")
      ->Form("NAME")
      ->Group(kServerGroup);
  app->Add("--token-file", &server->token_file,
           "Token that identifies the caller; only sent encrypted or to this machine")
      ->Form("FILE")
      ->Group(kServerGroup);
  app->Add("--authority", &server->authority,
           "Name of the server that a proxy routes by, if it differs from the address")
      ->Form("NAME")
      ->Group(kServerGroup);
}

}  // namespace duet::client::cli
