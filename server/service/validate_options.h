#ifndef DUET_SERVER_SERVICE_VALIDATE_OPTIONS_H_
#define DUET_SERVER_SERVICE_VALIDATE_OPTIONS_H_

#include "duet/v1/synthesis.pb.h"
#include "model/engine/synthesis_options.h"
#include "server/service/request_limits.h"
#include "server/service/violations.h"

namespace duet::server::service {

// Reads the optional fields of a request that configure the synthesis: seed, variety, clean_up.
// Adds every invalid field to `violations`; the result is then meaningless.
engine::SynthesisOptions ValidateOptions(const v1::SynthesizeRequest& request,
                                         const RequestLimits& limits, Violations& violations);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_VALIDATE_OPTIONS_H_
