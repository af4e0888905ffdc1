#ifndef DUET_SERVER_SERVICE_MODEL_MESSAGE_H_
#define DUET_SERVER_SERVICE_MODEL_MESSAGE_H_

#include "duet/v1/model.pb.h"
#include "duet/v1/synthesis.pb.h"
#include "server/registry/model_registry.h"
#include "server/service/request_limits.h"

namespace duet::server::service {

// Convert between the registry's and the limits' types and proto messages.
registry::ModelQuery ToQuery(const v1::ModelSelector& selector);
v1::Model ToMessage(const registry::ServedModel& served);
v1::RequestLimits ToMessage(const RequestLimits& limits);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_MODEL_MESSAGE_H_
