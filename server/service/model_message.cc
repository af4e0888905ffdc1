#include "server/service/model_message.h"

#include <string>

#include "model/engine/live_synthesis.h"

namespace duet::server::service {

registry::ModelQuery ToQuery(const v1::ModelSelector& selector) {
  registry::ModelQuery query;
  query.name = selector.name();
  if (selector.has_version()) query.version = selector.version();
  if (selector.has_version_label()) query.version_label = selector.version_label();
  return query;
}

v1::Model ToMessage(const registry::ServedModel& served) {
  const engine::ModelDescription& model = served.model->description();
  v1::Model message;
  message.set_name(model.name);
  message.set_version(static_cast<uint32_t>(model.version));
  for (const std::string& label : served.version_labels) message.add_version_labels(label);
  message.set_is_default(served.is_default);
  for (const std::string& name : model.classes) message.add_interaction_classes(name);
  for (const std::string& name : model.skeleton.joint_names) message.add_joint_names(name);
  for (const motion::Bone& bone : model.skeleton.bones) {
    v1::Bone* added = message.add_bones();
    added->set_parent_joint(static_cast<uint32_t>(bone.parent));
    added->set_child_joint(static_cast<uint32_t>(bone.child));
  }
  message.set_root_joint(model.skeleton.joint_names[static_cast<std::size_t>(model.skeleton.root)]);
  message.set_frame_rate_hz(model.frame_rate_hz);
  message.set_window_frames(static_cast<uint32_t>(model.window_frames));
  message.set_accepts_follower_start(model.accepts_follower_start);
  message.set_samples(model.samples);
  message.set_description(model.description);
  message.set_terms(model.terms);
  message.set_free_for_all_uses(model.free_for_all_uses);
  message.set_weights_sha256(model.weights_sha256);
  message.set_answers_live(engine::AnswersLive(model));
  return message;
}

v1::RequestLimits ToMessage(const RequestLimits& limits) {
  v1::RequestLimits message;
  message.set_min_frame_rate_hz(limits.min_frame_rate_hz);
  message.set_max_frame_rate_hz(limits.max_frame_rate_hz);
  message.set_min_frames(static_cast<uint32_t>(limits.min_frames));
  message.set_max_duration_seconds(limits.max_duration_seconds);
  message.set_max_chunk_frames(static_cast<uint32_t>(limits.max_chunk_frames));
  message.set_max_label_keyframes(static_cast<uint32_t>(limits.max_label_keyframes));
  message.set_max_abs_weight(limits.max_abs_weight);
  message.set_max_request_bytes(limits.max_request_bytes);
  message.set_max_variety(limits.max_variety);
  message.set_max_candidates(static_cast<uint32_t>(limits.max_candidates));
  message.set_max_delay_frames(static_cast<uint32_t>(limits.max_delay_frames));
  message.set_max_plan_frames(static_cast<uint32_t>(limits.max_plan_frames));
  message.set_max_constraints(static_cast<uint32_t>(limits.max_constraints));
  return message;
}

}  // namespace duet::server::service
