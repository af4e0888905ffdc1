#include "tests/server/support/sample_request.h"

#include "model/motion/skeleton.h"
#include "tests/support/sample_motion.h"

namespace duet::test {

v1::SynthesizeRequest SampleRequest(int frames) {
  v1::SynthesizeRequest request;
  v1::Motion& leader = *request.mutable_leader();
  for (const std::string& name : motion::SbuSkeleton().joint_names) leader.add_joint_names(name);
  leader.set_frame_rate_hz(15);
  leader.set_unit(v1::LENGTH_UNIT_METRES);
  leader.set_up_axis(v1::UP_AXIS_Y_UP);
  leader.set_frame_count(frames);
  const motion::Poses swaying = SwayingMotion(frames, 15);
  for (const motion::Vec3& position : swaying.all()) {
    leader.add_positions(position.x);
    leader.add_positions(position.y);
    leader.add_positions(position.z);
  }
  AddWeight(*request.mutable_label_vector(), "kick", 1);
  return request;
}

void AddWeight(v1::LabelVector& label_vector, const std::string& interaction_class, float weight) {
  v1::ClassWeight& added = *label_vector.add_weights();
  added.set_interaction_class(interaction_class);
  added.set_weight(weight);
}

}  // namespace duet::test
