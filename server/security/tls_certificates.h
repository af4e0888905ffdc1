#ifndef DUET_SERVER_SECURITY_TLS_CERTIFICATES_H_
#define DUET_SERVER_SECURITY_TLS_CERTIFICATES_H_

#include <cstdint>
#include <memory>

#include "server/common/mutex.h"
#include "server/security/tls_material.h"

namespace duet::server::security {

// What the next handshake uses. Replaced while connections come; those that are open stay as they
// are.
//
// Threads: safe to call concurrently. Uses neither gRPC nor abseil's synchronisation.
class TlsCertificates {
 public:
  struct Current {
    std::shared_ptr<const TlsMaterial> material;
    std::uint64_t generation = 0;  // another one after each Replace
  };

  explicit TlsCertificates(TlsMaterial material);

  void Replace(TlsMaterial material);
  Current current() const;

 private:
  mutable common::Mutex mutex_;
  Current current_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_TLS_CERTIFICATES_H_
