#ifndef DUET_SERVER_SERVICE_VALIDATOR_H_
#define DUET_SERVER_SERVICE_VALIDATOR_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "duet/v1/synthesis.pb.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/model_description.h"
#include "server/batching/window_scheduler.h"
#include "server/service/reply_mapping.h"
#include "server/service/request_limits.h"

namespace duet::server::service {

// Returns the priority of a request. Defaults to interactive; absent if the value is unknown.
std::optional<batching::Priority> PriorityOf(const v1::SynthesizeRequest& request);

// A valid SynthesizeRequest, converted to the model's joints, units and classes.
struct ValidatedRequest {
  engine::ClipRequest clip;
  ReplyMapping reply;
  int chunk_frames = 0;
  batching::Priority priority = batching::Priority::kInteractive;
};

// Validates every field of a request against a model and the limits. Returns INVALID_ARGUMENT or
// FAILED_PRECONDITION with a BadRequest that names every invalid field. `request` is untrusted.
absl::StatusOr<ValidatedRequest> ValidateRequest(const v1::SynthesizeRequest& request,
                                                 const engine::ModelDescription& model,
                                                 const RequestLimits& limits);

// Like ValidateRequest, for requests whose leader has other limits than RequestLimits says, or
// none. Label keyframes lie before frame `label_frames`. Violations have the given prefix.
struct RequestForm {
  std::string prefix;
  uint32_t label_frames = 0;
};
absl::StatusOr<ValidatedRequest> ValidateRequest(const v1::SynthesizeRequest& request,
                                                 const engine::ModelDescription& model,
                                                 const RequestLimits& limits,
                                                 const RequestForm& form);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_VALIDATOR_H_
