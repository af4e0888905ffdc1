#ifndef DUET_SERVER_SECURITY_SECRET_FILES_H_
#define DUET_SERVER_SECURITY_SECRET_FILES_H_

#include <grpcpp/security/server_credentials.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "server/common/mutex.h"
#include "server/security/access_control.h"

namespace duet::server::security {

// The server's certificate and key, and the authorities that it trusts. PEM text.
struct TlsMaterial {
  std::string certificate_chain;  // the server's own certificate first
  std::string private_key;
  std::string client_authorities;  // sign client certificates; empty: clients need none

  bool operator==(const TlsMaterial& other) const {
    return certificate_chain == other.certificate_chain && private_key == other.private_key &&
           client_authorities == other.client_authorities;
  }
};

// The files of TlsMaterial. No certificate file: no TLS.
struct TlsFiles {
  std::filesystem::path certificate;
  std::filesystem::path key;
  std::filesystem::path client_ca;  // empty: clients need no certificate
};

// Reads the files without checking their content. Fails with one line for each file that cannot be
// read: the setting and the file.
absl::StatusOr<TlsMaterial> ReadTlsMaterial(const TlsFiles& files);

// Checks that a handshake can succeed: certificates and key are PEM, the key belongs to the first
// certificate, and that certificate is valid now. Returns the end of its validity.
// Fails with INVALID_ARGUMENT and one line for each wrong setting; never with any part of the key.
absl::StatusOr<absl::Time> CheckTlsMaterial(const TlsMaterial& material);

// The certificates for the next handshake. They can be replaced at any time; open connections keep
// theirs.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil's synchronisation.
class TlsCertificates {
 public:
  struct Current {
    std::shared_ptr<const TlsMaterial> material;
    std::uint64_t generation = 0;  // changes with each Replace
  };

  explicit TlsCertificates(TlsMaterial material);

  void Replace(TlsMaterial material);
  Current current() const;

 private:
  mutable common::Mutex mutex_;
  Current current_ DUET_GUARDED_BY(mutex_);
};

// Makes credentials for one listening port. Every handshake reads `certificates`, so that a
// replacement applies from the next connection. Supports TLS 1.2 and 1.3. A client certificate is
// required and verified if the material has client authorities.
//
// `certificates` outlives the server. Call it once for each port. Whether clients need a
// certificate is fixed here: later material may have other client authorities, but must have some
// if and only if this one has.
std::shared_ptr<grpc::ServerCredentials> MakeServerCredentials(const TlsCertificates& certificates);

// Every call searches the whole list.
inline constexpr std::size_t kMaxCallers = 1000;

// Maximum number of mistakes that are reported for a file.
inline constexpr std::size_t kMaxAccessMistakes = 20;

// Parses an access file: one caller per line, words separated by blanks, comments after `#`.
//
//   # name    roles             known by                        limit
//   studio-a  synthesise        sha256:9f86d081...0f00a08       calls_per_second=20
//   studio-b  synthesise        cert:b.example.com
//   ops       synthesise,admin  sha256:60303ae2...7ba3b0dd2e2   sha256:fd61a03a...af6b2fc0c
//
// A name is 1 to 64 letters, digits, '-', '_' and '.'. Tokens (their SHA-256, never the token) and
// names in its certificate identify a caller; all of them share its limit.
//
// `certificates`: whether clients have certificates (tls_client_ca_file). Without them, cert:
// identifies no caller. A file without callers is a mistake, because it would reject every call.
//
// Errors: INVALID_ARGUMENT, one line "source:line: expected ..., got ..." for each of the first
//         kMaxAccessMistakes wrong lines; never a whole digest.
absl::StatusOr<std::vector<Caller>> ParseAccessList(std::string_view text, std::string_view source,
                                                    bool certificates = true);

// A changed file, or changed files that belong together, that were read again.
struct Reload {
  std::string_view kind;  // "access" or "tls"
  absl::Status status;    // not OK: rejected, and the previous content stays in use
};

// Follows the access file and the certificate files on disk.
//
// A change is detected by content, so that files may be rewritten in place, replaced, or reached
// through a symbolic link that moves, as in Kubernetes. Invalid content is rejected, once for each
// change, and the previous content stays in use. The same holds while only one of certificate and
// key is new.
//
// Threads: safe to call concurrently.
class SecretFiles {
 public:
  struct Options {
    TlsFiles tls;                  // no certificate: plain text
    std::filesystem::path access;  // empty: no access list
  };

  // Reads the files. Fails with INVALID_ARGUMENT, NOT_FOUND or PERMISSION_DENIED and one line for
  // each mistake in any of them: the setting, the file, and the line of an access file.
  static absl::StatusOr<std::unique_ptr<SecretFiles>> Open(Options options);

  // Reads the files again, applies changes and returns them. For an operator's request.
  std::vector<Reload> Refresh();

  // Does the same for files whose content equals that of the previous call, so that files that are
  // being written are skipped. Call it about once a second.
  std::vector<Reload> Look();

  // OK, or why the files on disk are not in use: one line for each mistake in the files that were
  // rejected and have not been corrected since.
  absl::Status state() const;

  // Null without a certificate.
  const TlsCertificates* certificates() const { return certificates_.get(); }
  // Null without an access file.
  const AccessControl* access() const { return access_.get(); }
  // The end of the certificate's validity; the infinite future without a certificate.
  absl::Time certificate_end() const;

 private:
  explicit SecretFiles(Options options) : options_(std::move(options)) {}
  std::vector<Reload> Read(bool settled);
  absl::StatusOr<std::string> ReadAccess() const;
  absl::Status TakeAccess(const absl::StatusOr<std::string>& text);
  absl::Status TakeTls(const absl::StatusOr<TlsMaterial>& material) DUET_REQUIRES(mutex_);

  // The last content of a file, or the reason why it could not be read.
  template <typename Content>
  class Seen {
   public:
    // Returns whether the content differs from the one applied last and, if `settled`, equals that
    // of the previous call. Reports a change once, even if it is rejected.
    bool Changed(const absl::StatusOr<Content>& now, bool settled) {
      const bool is_settled = !settled || Same(found_, now);
      found_ = now;
      if (!is_settled || Same(taken_, now)) return false;
      taken_ = now;
      return true;
    }

   private:
    static bool Same(const absl::StatusOr<Content>& a, const absl::StatusOr<Content>& b) {
      return a.ok() == b.ok() && (a.ok() ? *a == *b : a.status() == b.status());
    }
    absl::StatusOr<Content> found_ = absl::UnknownError("not read yet");  // by the previous call
    absl::StatusOr<Content> taken_ = absl::UnknownError("not read yet");
  };

  const Options options_;
  std::unique_ptr<AccessControl> access_;
  std::unique_ptr<TlsCertificates> certificates_;
  mutable common::Mutex mutex_;
  Seen<std::string> seen_access_ DUET_GUARDED_BY(mutex_);
  Seen<TlsMaterial> seen_tls_ DUET_GUARDED_BY(mutex_);
  absl::Status access_state_ DUET_GUARDED_BY(mutex_);  // result of the last change
  absl::Status tls_state_ DUET_GUARDED_BY(mutex_);
  absl::Time certificate_end_ DUET_GUARDED_BY(mutex_) = absl::InfiniteFuture();
};

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_SECRET_FILES_H_
