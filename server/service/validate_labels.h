#ifndef DUET_SERVER_SERVICE_VALIDATE_LABELS_H_
#define DUET_SERVER_SERVICE_VALIDATE_LABELS_H_

#include <vector>

#include "duet/v1/synthesis.pb.h"
#include "model/engine/label_track.h"
#include "model/engine/model_description.h"
#include "server/service/request_limits.h"
#include "server/service/violations.h"

namespace duet::server::service {

// Reads the request's label vector or keyframes, in the model's class order. A label vector becomes
// one keyframe at frame 0. Adds every invalid field to `violations`; the result is then
// meaningless.
std::vector<engine::LabelKeyframe> ValidateLabels(const v1::SynthesizeRequest& request,
                                                  const engine::ModelDescription& model,
                                                  const RequestLimits& limits,
                                                  Violations& violations);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_VALIDATE_LABELS_H_
