#include "server/service/priority_message.h"

namespace duet::server::service {

std::optional<batching::Priority> PriorityOf(const v1::SynthesizeRequest& request) {
  if (!request.has_priority()) return batching::Priority::kInteractive;
  switch (request.priority()) {
    case v1::PRIORITY_INTERACTIVE:
      return batching::Priority::kInteractive;
    case v1::PRIORITY_BULK:
      return batching::Priority::kBulk;
    default:
      return std::nullopt;
  }
}

}  // namespace duet::server::service
