#include "client/cli/server.h"

#include <atomic>
#include <cstddef>
#include <memory>
#include <ostream>
#include <string>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "client/error_details.h"
#include "client/internal/connect.h"
#include "model/base/file.h"
#include "model/base/program_flags.h"

namespace duet::client::cli {
namespace {

// A key or a certificate chain has a few kilobytes. A much larger file is not one.
constexpr std::size_t kMaxPemBytes = std::size_t{1} << 20;

// The token, which is the only line of the file. Does nothing if `path` is empty.
absl::Status ReadToken(const std::string& path, std::string* token) {
  if (path.empty()) return absl::OkStatus();
  constexpr std::size_t kMaxTokenBytes = 4096;
  absl::StatusOr<std::string> content = base::ReadFile(path, kMaxTokenBytes, "a token");
  if (!content.ok()) return content.status();
  *token = std::string(absl::StripAsciiWhitespace(*content));
  if (!token->empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(path, ": expected a token, got an empty file"));
}

// Does nothing if `path` is empty.
absl::Status ReadPem(const std::string& path, std::string* pem) {
  if (path.empty()) return absl::OkStatus();
  absl::StatusOr<std::string> content = base::ReadFile(path, kMaxPemBytes, "a PEM file");
  if (!content.ok()) return content.status();
  // Without authorities, a client would trust those of the system.
  if (content->empty()) {
    return absl::InvalidArgumentError(absl::StrCat(path, ": expected PEM, got an empty file"));
  }
  *pem = *std::move(content);
  return absl::OkStatus();
}

absl::Status ReadTls(const ServerArguments& arguments, TlsOptions* tls) {
  tls->server_name = arguments.tls_server_name;
  absl::Status status = ReadPem(arguments.tls_ca_file, &tls->root_certificates);
  status.Update(ReadPem(arguments.tls_certificate_file, &tls->certificate_chain));
  status.Update(ReadPem(arguments.tls_key_file, &tls->private_key));
  if (!status.ok()) return status;
  return internal::CheckTls(*tls, {absl::StrCat("tls_ca: ", arguments.tls_ca_file),
                                   absl::StrCat("tls_cert: ", arguments.tls_certificate_file),
                                   absl::StrCat("tls_key: ", arguments.tls_key_file)});
}

void ReportWaiting(const ServerArguments& arguments, std::ostream& err, ClientOptions* options) {
  options->retry.on_wait = [&err, address = arguments.address,
                            waits = std::make_shared<std::atomic<int>>(0)](const absl::Status& why,
                                                                           absl::Duration) {
    if (++*waits != 2) return;
    // Only a server's own error has a reason; the others name the address.
    const bool answered = !ErrorReason(why).empty();
    err << "duet: " << (answered ? absl::StrCat("the server at ", address, " is not ready: ") : "")
        << why.message() << "; retrying\n";
  };
}

// TLS, the token, and the name for a proxy.
void AddCredentialFlags(CLI::App* app, ServerArguments* server) {
  const auto add = [app](const char* flag, const char* variable, const char* form,
                         std::string* value, const char* help) {
    return AddValue(app, kServerGroup, flag, form, value, help)->envname(variable);
  };
  app->add_flag("--tls", server->tls, "Encrypt; trust the certificate authorities of the system")
      ->envname("DUET_TLS")
      ->group(kServerGroup);
  add("--tls-ca", "DUET_TLS_CA", "FILE", &server->tls_ca_file,
      "Encrypt; trust the certificate authorities in this file");
  CLI::Option* certificate = add("--tls-cert", "DUET_TLS_CERT", "FILE",
                                 &server->tls_certificate_file, "Certificate of this client");
  CLI::Option* key =
      add("--tls-key", "DUET_TLS_KEY", "FILE", &server->tls_key_file, "Private key of this client");
  certificate->needs(key);
  key->needs(certificate);
  add("--tls-server-name", "DUET_TLS_SERVER_NAME", "NAME", &server->tls_server_name,
      "Name in the server's certificate, if it differs from the address");
  add("--token-file", "DUET_TOKEN_FILE", "FILE", &server->token_file,
      "Token that identifies the caller; only sent encrypted or to this machine");
  add("--authority", "DUET_AUTHORITY", "NAME", &server->authority,
      "Name of the server that a proxy routes by, if it differs from the address");
}

}  // namespace

void AddServerFlags(CLI::App* app, ServerArguments* server) {
  AddValue(app, kServerGroup, "--server", "HOST:PORT", &server->address,
           "Server, or any gRPC target such as unix:/run/duet.sock")
      ->envname("DUET_SERVER")
      ->capture_default_str();
  AddValue(app, kServerGroup, "--wait", "SECONDS", &server->wait_seconds,
           "Seconds to retry a server that cannot be reached; at most --timeout")
      ->check(base::InRange(0.0, 86400.0))
      ->envname("DUET_WAIT")
      ->capture_default_str();
  AddConnectionFlags(app, server);
}

void AddConnectionFlags(CLI::App* app, ServerArguments* server) {
  AddValue(app, kServerGroup, "--timeout", "SECONDS", &server->timeout_seconds,
           "Deadline of the whole call, with retries")
      ->check(base::InRange(0.001, 86400.0))
      ->envname("DUET_TIMEOUT")
      ->capture_default_str();
  AddCredentialFlags(app, server);
}

absl::StatusOr<ClientOptions> ToClientOptions(const ServerArguments& arguments) {
  ClientOptions options;
  options.server_address = arguments.address;
  options.deadline = absl::Seconds(arguments.timeout_seconds);
  options.wait = absl::Seconds(arguments.wait_seconds);
  options.authority = arguments.authority;
  absl::Status status = ReadToken(arguments.token_file, &options.token);
  if (!status.ok()) return status;
  const bool encrypted = arguments.tls || !arguments.tls_ca_file.empty() ||
                         !arguments.tls_certificate_file.empty() ||
                         !arguments.tls_server_name.empty();
  if (!encrypted) return options;
  TlsOptions tls;
  status = ReadTls(arguments, &tls);
  if (!status.ok()) return status;
  options.tls = std::move(tls);
  return options;
}

absl::StatusOr<Client> Connect(const ServerArguments& arguments,
                               const ProgramEnvironment& environment) {
  absl::StatusOr<ClientOptions> options = ToClientOptions(arguments);
  if (!options.ok()) return options.status();
  ReportWaiting(arguments, *environment.err, &*options);
  return environment.connect(*options);
}

}  // namespace duet::client::cli
