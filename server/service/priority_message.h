#ifndef DUET_SERVER_SERVICE_PRIORITY_MESSAGE_H_
#define DUET_SERVER_SERVICE_PRIORITY_MESSAGE_H_

#include <optional>

#include "duet/v1/synthesis.pb.h"
#include "server/batching/priority.h"

namespace duet::server::service {

// Returns the priority of a request. Defaults to interactive; absent if the value is unknown.
std::optional<batching::Priority> PriorityOf(const v1::SynthesizeRequest& request);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_PRIORITY_MESSAGE_H_
