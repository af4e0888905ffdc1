#include "server/security/tls_certificates.h"

#include <utility>

namespace duet::server::security {

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

}  // namespace duet::server::security
