#ifndef DUET_SERVER_SECURITY_TLS_CERTIFICATES_H_
#define DUET_SERVER_SECURITY_TLS_CERTIFICATES_H_

#include <cstdint>
#include <memory>

#include "server/common/mutex.h"
#include "server/security/tls_material.h"

namespace duet::server::security {

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

}  // namespace duet::server::security

#endif  // DUET_SERVER_SECURITY_TLS_CERTIFICATES_H_
