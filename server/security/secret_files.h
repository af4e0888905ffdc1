#ifndef DUET_SERVER_SECURITY_SECRET_FILES_H_
#define DUET_SERVER_SECURITY_SECRET_FILES_H_

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"
#include "server/security/access_control.h"
#include "server/security/tls_certificates.h"
#include "server/security/tls_material.h"

namespace duet::server::security {

// A file, or files that belong together, that changed and was read again.
struct Reload {
  std::string_view kind;  // "access" or "tls"
  absl::Status status;    // not OK: it was refused, and what was there before counts on
};

// The files that say who may call and what the server shows them, kept as they are on disk.
//
// What changed is known by the files' contents: rewritten in place, replaced, or behind a symbolic
// link that moved, as Kubernetes does it. What makes no sense is refused, once for each change, and
// what was there before counts on; so do certificate and key while only one of them is new.
//
// Threads: safe to call concurrently.
class SecretFiles {
 public:
  struct Options {
    TlsFiles tls;                                         // no certificate: plain text
    std::filesystem::path access;                         // empty: no access list
    const common::Clock* clock = &common::Clock::Real();  // of the callers' limits
    std::function<absl::Time()> now = absl::Now;          // of certificates
  };

  // Reads the files. Fails with INVALID_ARGUMENT, NOT_FOUND or PERMISSION_DENIED, one line for each
  // mistake in any of them: the setting, the file, and in an access file the line.
  static absl::StatusOr<std::unique_ptr<SecretFiles>> Open(Options options);

  // Reads them again and takes over what changed; says what that was. For when somebody says that
  // they are ready.
  std::vector<Reload> Refresh();

  // The same for what has settled: contents that the last look found as well, so that a file that
  // is being written is left alone. Call about once a second.
  std::vector<Reload> Look();

  // OK, or why the files on disk are not in use: one line for each mistake in those that were
  // refused last and have not been mended since.
  absl::Status state() const;

  // Null without a certificate.
  const TlsCertificates* certificates() const { return certificates_.get(); }
  // Null without an access file.
  const AccessControl* access() const { return access_.get(); }
  // Until when the server's certificate is valid; the infinite future without one.
  absl::Time certificate_end() const;

 private:
  explicit SecretFiles(Options options) : options_(std::move(options)) {}
  std::vector<Reload> Read(bool settled);
  absl::StatusOr<std::string> ReadAccess() const;
  absl::Status TakeAccess(const absl::StatusOr<std::string>& text);
  absl::Status TakeTls(const absl::StatusOr<TlsMaterial>& material) DUET_REQUIRES(mutex_);

  // What a file held: its contents, or why it could not be read.
  template <typename Content>
  class Seen {
   public:
    // Whether it is another one than was taken last, and has settled if it is to. A change is told
    // once, whatever comes of it.
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
    absl::StatusOr<Content> found_ = absl::UnknownError("not read yet");  // by the last look
    absl::StatusOr<Content> taken_ = absl::UnknownError("not read yet");
  };

  const Options options_;
  std::unique_ptr<AccessControl> access_;
  std::unique_ptr<TlsCertificates> certificates_;
  mutable common::Mutex mutex_;
  Seen<std::string> seen_access_ DUET_GUARDED_BY(mutex_);
  Seen<TlsMaterial> seen_tls_ DUET_GUARDED_BY(mutex_);
  absl::Status access_state_ DUET_GUARDED_BY(mutex_);  // of what was read last
  absl::Status tls_state_ DUET_GUARDED_BY(mutex_);
  absl::Time certificate_end_ DUET_GUARDED_BY(mutex_) = absl::InfiniteFuture();
};

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_SECRET_FILES_H_
