#include "tests/server/support/sample_request.h"

#include "model/motion/skeleton.h"
#include "tests/support/sample_motion.h"

namespace duet::test {
namespace {

void AddPositions(absl::Span<const motion::Vec3> positions,
                  google::protobuf::RepeatedField<float>* values) {
  for (const motion::Vec3& position : positions) {
    for (const float value : {position.x, position.y, position.z}) values->Add(value);
  }
}

}  // namespace

v1::SynthesizeRequest SampleRequest(int frames) {
  v1::SynthesizeRequest request;
  v1::Motion& leader = *request.mutable_leader();
  for (const std::string& name : motion::SbuSkeleton().joint_names) leader.add_joint_names(name);
  leader.set_frame_rate_hz(15);
  leader.set_unit(v1::LENGTH_UNIT_METRES);
  leader.set_up_axis(v1::UP_AXIS_Y_UP);
  leader.set_frame_count(frames);
  AddPositions(SwayingMotion(frames, 15).all(), leader.mutable_positions());
  AddWeight(*request.mutable_label_vector(), "kick", 1);
  return request;
}

void AddWeight(v1::LabelVector& label_vector, const std::string& interaction_class, float weight) {
  v1::ClassWeight& added = *label_vector.add_weights();
  added.set_interaction_class(interaction_class);
  added.set_weight(weight);
}

v1::LiveStart SampleLiveStart(int frames) {
  v1::SynthesizeRequest sample = SampleRequest(frames);
  v1::LiveStart start;
  start.mutable_leader()->Swap(sample.mutable_leader());
  start.mutable_label_vector()->Swap(sample.mutable_label_vector());
  if (frames == 0) return start;
  v1::LiveHistory& history = *start.mutable_history();
  *history.mutable_follower_positions() = start.leader().positions();
  history.set_follower_frame_count(static_cast<uint32_t>(frames));
  return start;
}

v1::LeaderFrames SampleLeaderFrames(int first, int count) {
  static const auto& leader = *new motion::Poses(SwayingMotion(400, 15));
  v1::LeaderFrames frames;
  frames.set_first_frame(static_cast<uint32_t>(first));
  frames.set_frame_count(static_cast<uint32_t>(count));
  frames.set_capture_seconds(first + count - 1);
  AddPositions(leader.frames(first, count), frames.mutable_positions());
  return frames;
}

}  // namespace duet::test
