#include "client/cli/server_options.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/text.h"

namespace duet::client::cli {
namespace {

constexpr std::uintmax_t kMaxPemBytes = std::uintmax_t{1} << 20;

// A key or a chain of certificates is some kilobytes; whatever is far larger is another file.
absl::StatusOr<std::string> ReadPemFile(const std::string& path) {
  std::error_code error;  // what cannot be read at all is said by ReadFile
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (!error && bytes > kMaxPemBytes) {
    return absl::InvalidArgumentError(absl::StrCat(
        path, ": ", bytes, " bytes, wanted a PEM file of at most ", kMaxPemBytes, " bytes"));
  }
  return base::ReadFile(path, kMaxPemBytes);
}

// Nothing for a file that was not named.
absl::Status ReadPem(const std::string& path, std::string* pem) {
  if (path.empty()) return absl::OkStatus();
  absl::StatusOr<std::string> content = ReadPemFile(path);
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

}  // namespace duet::client::cli
