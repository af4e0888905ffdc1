#include "contrib/load/live_start.h"

#include <cstdint>

#include "client/internal/proto_conversion.h"

namespace duet::contrib::load {

absl::StatusOr<v1::LiveStart> MakeLiveStart(const LiveContent& content,
                                            const client::ModelInfo& model, double frame_rate_hz) {
  client::SynthesisRequest request;
  request.model = content.model;
  request.leader.joint_names = model.joint_names;
  request.leader.frame_rate_hz = frame_rate_hz;
  request.weights = content.labels;
  if (request.weights.empty()) request.weights = {{model.interaction_classes.front(), 1}};
  absl::StatusOr<v1::SynthesizeRequest> wire = client::internal::ToProto(request);
  if (!wire.ok()) return wire.status();
  v1::LiveStart start;
  *start.mutable_model() = wire->model();
  *start.mutable_leader() = wire->leader();
  *start.mutable_label_vector() = wire->label_vector();
  start.set_delay_frames(static_cast<uint32_t>(content.delay_frames));
  start.set_plan_frames(static_cast<uint32_t>(content.plan_frames));
  return start;
}

}  // namespace duet::contrib::load
