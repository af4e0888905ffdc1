#ifndef DUET_SERVER_SERVICE_VALIDATE_LABELS_H_
#define DUET_SERVER_SERVICE_VALIDATE_LABELS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "duet/v1/synthesis.pb.h"
#include "model/engine/label_track.h"
#include "model/engine/model_description.h"
#include "server/service/request_limits.h"
#include "server/service/violations.h"

namespace duet::server::service {

// Reads the request's label vector or keyframes, in the model's class order. A label vector becomes
// one keyframe at frame 0. `frames`: keyframes lie before this frame. Adds every invalid field to
// `violations`; the result is then meaningless.
std::vector<engine::LabelKeyframe> ValidateLabels(const v1::SynthesizeRequest& request,
                                                  uint32_t frames,
                                                  const engine::ModelDescription& model,
                                                  const RequestLimits& limits,
                                                  Violations& violations);

// Reads one label vector, the field `field`, in the model's class order. Shapes: returns [classes].
std::vector<float> ReadLabelVector(const std::string& field, const v1::LabelVector& label_vector,
                                   const engine::ModelDescription& model,
                                   const RequestLimits& limits, Violations& violations);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_VALIDATE_LABELS_H_
