#include "server/security/secret_files.h"

#include <grpc/grpc.h>
#include <grpc/grpc_security.h>
#include <openssl/x509.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <ctime>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "absl/time/clock.h"
#include "model/base/counted.h"
#include "model/base/file.h"
#include "model/base/pem.h"
#include "model/base/text.h"
#include "server/common/error_details.h"

namespace duet::server::security {

namespace {

// A bundle of all public authorities has about 200 kB; a far larger file is a mistake.
constexpr std::size_t kMaxPemBytes = std::size_t{1} << 20;

absl::Time ToTime(const ASN1_TIME* time) {
  std::tm fields = {};
  return ASN1_TIME_to_tm(time, &fields) == 1 ? absl::FromTimeT(timegm(&fields))
                                             : absl::InfinitePast();
}

absl::Status ReadPem(absl::string_view setting, const std::filesystem::path& path,
                     std::string* pem) {
  if (path.empty()) return absl::OkStatus();
  absl::StatusOr<std::string> text = base::ReadFile(path, kMaxPemBytes, "a PEM file");
  if (!text.ok()) {
    return absl::Status(text.status().code(), absl::StrCat(setting, ": ", text.status().message()));
  }
  *pem = *std::move(text);
  return absl::OkStatus();
}

absl::Status CheckChain(const std::vector<base::Certificate>& chain) {
  if (chain.empty()) {
    return absl::InvalidArgumentError(
        "tls_certificate_file: expected PEM, the server's own certificate first, got none");
  }
  const absl::Time from = ToTime(X509_get0_notBefore(chain.front().get()));
  const absl::Time until = ToTime(X509_get0_notAfter(chain.front().get()));
  const absl::Time now = absl::Now();
  if (from <= now && now <= until) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("tls_certificate_file: expected a certificate that is valid now, got one valid "
                   "from ",
                   absl::FormatTime(from), " to ", absl::FormatTime(until)));
}

absl::Status CheckKey(const std::vector<base::Certificate>& chain, const base::PrivateKey& key) {
  if (key == nullptr) {
    return absl::InvalidArgumentError(
        "tls_key_file: expected a private key in PEM without a password, got none");
  }
  if (chain.empty() || base::IsKeyOf(chain.front(), key)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "tls_key_file: expected the key of the first certificate in tls_certificate_file, got "
      "another certificate's key");
}

absl::Status CheckAuthorities(const std::string& pem) {
  if (pem.empty() || !base::ReadCertificates(pem).empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "tls_client_ca_file: expected PEM certificates of those who sign clients', got none");
}

// The C++ interface of gRPC 1.51 takes certificates once, or makes gRPC watch their files, which
// leaves a server without a certificate while certificate and key do not match. The C interface
// calls back at each connection and keeps the last certificates that worked.
class RotatingCredentials final : public grpc::ServerCredentials {
 public:
  explicit RotatingCredentials(const TlsCertificates& certificates) : certificates_(certificates) {
    const bool mutual = !certificates.current().material->client_authorities.empty();
    credentials_ = grpc_ssl_server_credentials_create_with_options(
        grpc_ssl_server_credentials_create_options_using_config_fetcher(
            mutual ? GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY
                   : GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE,
            Fetch, this));
  }
  ~RotatingCredentials() override { grpc_server_credentials_release(credentials_); }

  void SetAuthMetadataProcessor(const std::shared_ptr<grpc::AuthMetadataProcessor>&) override {}

 private:
  int AddPortToServer(const std::string& address, grpc_server* server) override {
    return grpc_server_add_http2_port(server, address.c_str(), credentials_);
  }

  static grpc_ssl_certificate_config_reload_status Fetch(
      void* self, grpc_ssl_server_certificate_config** config) {
    return static_cast<RotatingCredentials*>(self)->Fetch(config);
  }

  grpc_ssl_certificate_config_reload_status Fetch(grpc_ssl_server_certificate_config** config) {
    const TlsCertificates::Current current = certificates_.current();
    if (given_.exchange(current.generation) == current.generation) {
      return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_UNCHANGED;
    }
    const TlsMaterial& material = *current.material;
    const grpc_ssl_pem_key_cert_pair pair = {material.private_key.c_str(),
                                             material.certificate_chain.c_str()};
    // The library requires authorities even if clients need no certificate; any PEM will do then.
    const std::string& authorities = material.client_authorities.empty()
                                         ? material.certificate_chain
                                         : material.client_authorities;
    *config = grpc_ssl_server_certificate_config_create(authorities.c_str(), &pair, 1);
    return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_NEW;
  }

  const TlsCertificates& certificates_;
  std::atomic<std::uint64_t> given_{0};  // the generation that gRPC has; the first is 1
  grpc_server_credentials* credentials_ = nullptr;
};

}  // namespace

absl::StatusOr<TlsMaterial> ReadTlsMaterial(const TlsFiles& files) {
  TlsMaterial material;
  const absl::Status status =
      common::Join({ReadPem("tls_certificate_file", files.certificate, &material.certificate_chain),
                    ReadPem("tls_key_file", files.key, &material.private_key),
                    ReadPem("tls_client_ca_file", files.client_ca, &material.client_authorities)});
  if (!status.ok()) return status;
  if (!files.client_ca.empty() && material.client_authorities.empty()) {
    // Empty authorities would mean that clients need no certificate.
    return absl::InvalidArgumentError(
        "tls_client_ca_file: expected PEM certificates, got an empty file");
  }
  return material;
}

absl::StatusOr<absl::Time> CheckTlsMaterial(const TlsMaterial& material) {
  const std::vector<base::Certificate> chain = base::ReadCertificates(material.certificate_chain);
  const base::PrivateKey key = base::ReadPrivateKey(material.private_key);
  const absl::Status status = common::Join(
      {CheckChain(chain), CheckKey(chain, key), CheckAuthorities(material.client_authorities)});
  if (!status.ok()) return status;
  return ToTime(X509_get0_notAfter(chain.front().get()));
}

TlsCertificates::TlsCertificates(TlsMaterial material) { Replace(std::move(material)); }

void TlsCertificates::Replace(TlsMaterial material) {
  auto next = std::make_shared<const TlsMaterial>(std::move(material));
  common::MutexLock lock(mutex_);
  current_ = {std::move(next), current_.generation + 1};
}

TlsCertificates::Current TlsCertificates::current() const {
  common::MutexLock lock(mutex_);
  return current_;
}

std::shared_ptr<grpc::ServerCredentials> MakeServerCredentials(
    const TlsCertificates& certificates) {
  return std::make_shared<RotatingCredentials>(certificates);
}

namespace {

constexpr std::size_t kMaxNameBytes = 64;
constexpr std::size_t kDigestCharacters = 64;
constexpr double kMaxCallsPerSecond = 1e6;

bool IsName(absl::string_view text) {
  return !text.empty() && text.size() <= kMaxNameBytes &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return absl::ascii_isalnum(c) || c == '-' || c == '_' || c == '.';
         });
}

bool IsDigest(absl::string_view text) {
  return text.size() == kDigestCharacters &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return absl::ascii_isxdigit(c); });
}

// Splits a word at the first `separator`. The second part is empty if there is none.
std::pair<absl::string_view, absl::string_view> Split(absl::string_view word, char separator) {
  return absl::StrSplit(word, absl::MaxSplits(separator, 1));
}

absl::Status Expected(absl::string_view expected, absl::string_view got) {
  return absl::InvalidArgumentError(
      absl::StrCat("expected ", expected, ", got ", base::Quoted(got)));
}

absl::Status ReadRoles(absl::string_view word, Caller& caller) {
  for (const absl::string_view role : absl::StrSplit(word, ',')) {
    if (role == RoleName(Role::kSynthesise)) {
      caller.roles.insert(Role::kSynthesise);
    } else if (role == RoleName(Role::kAdmin)) {
      caller.roles.insert(Role::kAdmin);
    } else {
      return Expected("the role synthesise, admin or both with a comma between them", role);
    }
  }
  return absl::OkStatus();
}

absl::Status ReadCallRate(absl::string_view text, Caller& caller) {
  double value = 0;
  if (!base::ParseNumber(text, &value) || value <= 0 || value > kMaxCallsPerSecond) {
    return Expected("calls_per_second as a number above 0 and up to a million", text);
  }
  caller.calls_per_second = value;
  return absl::OkStatus();
}

absl::Status ReadWord(absl::string_view word, Caller& caller) {
  if (const auto [name, value] = Split(word, '='); name == "calls_per_second") {
    return ReadCallRate(value, caller);
  }
  const auto [kind, value] = Split(word, ':');
  if (kind == "sha256") {
    // Not quoted, because an operator may have entered the token instead of its digest.
    if (!IsDigest(value)) {
      return absl::InvalidArgumentError(absl::StrCat(
          "expected the 64 hexadecimal digits of a token's SHA-256 after sha256:, got ",
          value.size(), " characters; printf %s TOKEN | sha256sum prints them"));
    }
    caller.token_digests.push_back(absl::AsciiStrToLower(value));
    return absl::OkStatus();
  }
  if (kind == "cert" && !value.empty()) {
    caller.certificate_names.emplace_back(value);
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      "expected sha256:DIGEST, cert:NAME or calls_per_second=N, got another word; it is not "
      "repeated "
      "here because it may be a token");
}

absl::StatusOr<Caller> ReadCaller(absl::string_view line) {
  const std::vector<absl::string_view> words =
      absl::StrSplit(line, absl::ByAnyChar(" \t"), absl::SkipEmpty());
  if (words.size() < 3) {
    return absl::InvalidArgumentError(
        absl::StrCat("expected a name, its roles and sha256:DIGEST or cert:NAME, got ",
                     base::Counted(words.size(), "word")));
  }
  Caller caller;
  caller.name = std::string(words[0]);
  if (!IsName(words[0])) {
    return Expected("a name of 1 to 64 letters, digits, '-', '_' and '.'", words[0]);
  }
  absl::Status status = ReadRoles(words[1], caller);
  for (std::size_t i = 2; i < words.size() && status.ok(); ++i) status = ReadWord(words[i], caller);
  if (!status.ok()) return status;
  if (caller.token_digests.empty() && caller.certificate_names.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat("expected sha256:DIGEST or cert:NAME for ", caller.name, ", got neither"));
  }
  return caller;
}

// Collects the callers of a file and its mistakes.
class AccessReader {
 public:
  // `certificates`: whether clients have any. Without them, a certificate's name identifies nobody.
  AccessReader(absl::string_view source, bool certificates)
      : source_(source), certificates_(certificates) {}

  void Read(int number, absl::string_view line) {
    absl::StatusOr<Caller> caller = ReadCaller(line);
    absl::Status status = caller.ok() ? Check(*caller) : caller.status();
    if (status.ok() && callers_.size() == kMaxCallers) {
      status =
          absl::InvalidArgumentError(absl::StrCat("expected at most ", kMaxCallers, " callers"));
    }
    if (!status.ok()) return Fail(base::ErrorAt(source_, number, status.message()));
    callers_.push_back(*std::move(caller));
  }

  absl::StatusOr<std::vector<Caller>> Take() {
    if (mistakes_.empty() && callers_.empty()) {
      Fail(absl::InvalidArgumentError(
          absl::StrCat(source_,
                       ": expected at least one caller, got none; without the setting "
                       "access_file everybody may synthesise")));
    }
    if (absl::Status status = common::Join(mistakes_); !status.ok()) return status;
    return std::move(callers_);
  }

 private:
  // Callers share neither names nor credentials: a shared token would not identify a caller.
  absl::Status Check(const Caller& caller) {
    absl::Status status = Once("each name", caller.name, caller.name);
    for (const std::string& digest : caller.token_digests) {
      if (status.ok()) status = Once("each token", digest, caller.name);
    }
    for (const std::string& name : caller.certificate_names) {
      if (status.ok()) status = Once("each certificate name", name, name);
      if (!status.ok() || certificates_) continue;
      status = absl::InvalidArgumentError(absl::StrCat(
          "expected no cert: without tls_client_ca_file, got ", base::Quoted("cert:" + name),
          "; set tls_client_ca_file, or give ", caller.name, " a token"));
    }
    return status;
  }

  // `shown`: in the error, in place of what must not be repeated.
  absl::Status Once(const std::string& what, const std::string& key, const std::string& shown) {
    if (taken_.insert({what, key}).second) return absl::OkStatus();
    return absl::InvalidArgumentError(
        absl::StrCat("expected ", what, " once, got ", base::Quoted(shown), " a second time"));
  }

  void Fail(absl::Status mistake) {
    if (mistakes_.size() < kMaxAccessMistakes) mistakes_.push_back(std::move(mistake));
  }

  const absl::string_view source_;
  const bool certificates_;
  std::set<std::pair<std::string, std::string>> taken_;
  std::vector<Caller> callers_;
  std::vector<absl::Status> mistakes_;
};

}  // namespace

absl::StatusOr<std::vector<Caller>> ParseAccessList(std::string_view text, std::string_view source,
                                                    bool certificates) {
  AccessReader reader({source.data(), source.size()}, certificates);
  base::LineReader lines(base::SkipByteOrderMark({text.data(), text.size()}));
  for (absl::string_view line; lines.Next(&line);) {
    line = absl::StripAsciiWhitespace(line);
    if (!line.empty() && line.front() != '#') reader.Read(lines.number(), line);
  }
  return reader.Take();
}

namespace {

constexpr std::size_t kMaxAccessBytes = std::size_t{1} << 20;

}  // namespace

absl::StatusOr<std::unique_ptr<SecretFiles>> SecretFiles::Open(Options options) {
  std::unique_ptr<SecretFiles> files(new SecretFiles(std::move(options)));
  if (!files->options_.access.empty()) {
    files->access_ = std::make_unique<AccessControl>(common::Clock::Real());
  }
  files->Refresh();
  const absl::Status state = files->state();
  if (!state.ok()) return state;
  return files;
}

std::vector<Reload> SecretFiles::Refresh() { return Read(/*settled=*/false); }

std::vector<Reload> SecretFiles::Look() { return Read(/*settled=*/true); }

std::vector<Reload> SecretFiles::Read(bool settled) {
  std::vector<Reload> changes;
  common::MutexLock lock(mutex_);
  if (!options_.access.empty()) {
    const absl::StatusOr<std::string> text = ReadAccess();
    if (seen_access_.Changed(text, settled)) {
      access_state_ = TakeAccess(text);
      changes.push_back({"access", access_state_});
    }
  }
  if (!options_.tls.certificate.empty()) {
    const absl::StatusOr<TlsMaterial> material = ReadTlsMaterial(options_.tls);
    if (seen_tls_.Changed(material, settled)) {
      tls_state_ = TakeTls(material);
      changes.push_back({"tls", tls_state_});
    }
  }
  return changes;
}

absl::StatusOr<std::string> SecretFiles::ReadAccess() const {
  absl::StatusOr<std::string> text =
      base::ReadFile(options_.access, kMaxAccessBytes, "an access file");
  if (text.ok()) return text;
  return absl::Status(text.status().code(), absl::StrCat("access_file: ", text.status().message()));
}

absl::Status SecretFiles::TakeAccess(const absl::StatusOr<std::string>& text) {
  if (!text.ok()) return text.status();
  absl::StatusOr<std::vector<Caller>> callers =
      ParseAccessList(*text, absl::StrCat("access_file: ", options_.access.string()),
                      /*certificates=*/!options_.tls.client_ca.empty());
  if (!callers.ok()) return callers.status();
  access_->Replace(*std::move(callers));
  return absl::OkStatus();
}

absl::Status SecretFiles::TakeTls(const absl::StatusOr<TlsMaterial>& material) {
  if (!material.ok()) return material.status();
  const absl::StatusOr<absl::Time> end = CheckTlsMaterial(*material);
  if (!end.ok()) return end.status();
  certificate_end_ = *end;
  if (certificates_ == nullptr) {
    certificates_ = std::make_unique<TlsCertificates>(*material);
  } else {
    certificates_->Replace(*material);
  }
  return absl::OkStatus();
}

absl::Status SecretFiles::state() const {
  common::MutexLock lock(mutex_);
  return common::Join({tls_state_, access_state_});
}

absl::Time SecretFiles::certificate_end() const {
  common::MutexLock lock(mutex_);
  return certificate_end_;
}

}  // namespace duet::server::security
