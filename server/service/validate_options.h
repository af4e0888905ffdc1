#ifndef DUET_SERVER_SERVICE_VALIDATE_OPTIONS_H_
#define DUET_SERVER_SERVICE_VALIDATE_OPTIONS_H_

#include <optional>

#include "duet/v1/synthesis.pb.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesis_options.h"
#include "model/motion/coordinates.h"
#include "model/motion/levelling.h"
#include "model/motion/pin.h"
#include "model/motion/poses.h"
#include "server/service/request_limits.h"
#include "server/service/violations.h"

namespace duet::server::service {

// Reads the optional fields of a request that configure the synthesis: seed, variety, clean_up.
// Adds every invalid field to `violations`; the result is then meaningless.
engine::SynthesisOptions ValidateOptions(const v1::SynthesizeRequest& request,
                                         const RequestLimits& limits, Violations& violations);

// The world of a request, as far as it is valid. The result for `constraints` is complete only if
// it is.
struct RequestWorld {
  std::optional<motion::Coordinates> coordinates;
  std::optional<motion::Levelling> levelling;
  const motion::Poses& leader;  // level world metres, the model's joints; empty if it is invalid
};

// Converts SynthesizeRequest.constraints to pins in the caller's frames, the model's joints and
// level world metres, in the same order. Adds every invalid one to `violations`; the result is then
// meaningless.
motion::Pins ValidateConstraints(const v1::SynthesizeRequest& request, const RequestWorld& world,
                                 const engine::ModelDescription& model, const RequestLimits& limits,
                                 Violations& violations);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_VALIDATE_OPTIONS_H_
