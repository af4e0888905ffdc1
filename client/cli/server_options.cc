#include "client/cli/server_options.h"

#include <atomic>
#include <cstddef>
#include <memory>
#include <ostream>
#include <string>
#include <utility>

#include "model/base/file.h"

namespace duet::client::cli {
namespace {

// A key or a chain of certificates is some kilobytes; whatever is far larger is another file.
constexpr std::size_t kMaxPemBytes = std::size_t{1} << 20;

// Nothing for a file that was not named.
absl::Status ReadPem(const std::string& path, std::string* pem) {
  if (path.empty()) return absl::OkStatus();
  absl::StatusOr<std::string> content = base::ReadFile(path, kMaxPemBytes, "a PEM file");
  if (!content.ok()) return content.status();
  *pem = *std::move(content);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<ClientOptions> ToClientOptions(const ServerArguments& arguments) {
  ClientOptions options;
  options.server_address = arguments.address;
  options.deadline = absl::Seconds(arguments.timeout_seconds);
  const bool encrypted = arguments.tls || !arguments.tls_ca_file.empty() ||
                         !arguments.tls_certificate_file.empty() ||
                         !arguments.tls_server_name.empty();
  if (!encrypted) return options;
  TlsOptions tls;
  tls.server_name = arguments.tls_server_name;
  absl::Status status = ReadPem(arguments.tls_ca_file, &tls.root_certificates);
  status.Update(ReadPem(arguments.tls_certificate_file, &tls.certificate_chain));
  status.Update(ReadPem(arguments.tls_key_file, &tls.private_key));
  if (!status.ok()) return status;
  options.tls = std::move(tls);
  return options;
}

void SayWhenWaiting(const ServerArguments& arguments, std::ostream& err, ClientOptions* options) {
  options->retry.on_wait = [&err, address = arguments.address, seconds = arguments.timeout_seconds,
                            waits = std::make_shared<std::atomic<int>>(0)](const absl::Status& why,
                                                                           absl::Duration) {
    if (++*waits != 2) return;
    err << "duet: " << address << " does not answer: " << why.message()
        << "; asked again until --timeout " << seconds << " s is over\n";
  };
}

}  // namespace duet::client::cli
