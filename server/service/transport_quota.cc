#include "server/service/transport_quota.h"

namespace duet::server::service {

TransportQuota::TransportQuota(std::size_t bytes) : bytes_(bytes), quota_("duet") {
  quota_.Resize(bytes);
}

void TransportQuota::Add(std::ptrdiff_t bytes) {
  common::MutexLock lock(mutex_);
  received_ += bytes;
  quota_.Resize(bytes_ + static_cast<std::size_t>(received_));
}

}  // namespace duet::server::service
