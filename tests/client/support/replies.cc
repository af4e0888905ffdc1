#include "tests/client/support/replies.h"

#include <google/protobuf/text_format.h>

#include <algorithm>

#include "absl/strings/cord.h"
#include "duet/rpc/v1/status.pb.h"
#include "gtest/gtest.h"

namespace duet::test {
client::internal::RetryEnvironment FakeTime::Environment() {
  return {[this] { return now; },
          [this](absl::Duration wait) {
            sleeps.push_back(wait);
            now += wait;
          },
          [this] { return uniform; }};
}

motion::Clip ThreeJointLeader(int frames) {
  motion::Clip clip;
  clip.joint_names = {"root", "left", "right"};
  clip.frame_rate_hz = 30;
  clip.poses = motion::Poses(frames, clip.joint_count());
  float value = 0;
  for (motion::Vec3& position : clip.poses.all()) {
    position = {value, 0.5f * value, -value};
    ++value;
  }
  return clip;
}

motion::Poses FollowerFor(const motion::Clip& leader) {
  motion::Poses follower = leader.poses;
  for (motion::Vec3& position : follower.all()) position.x += 1;
  return follower;
}

v1::SynthesizeResponse HeaderFor(const motion::Clip& leader) {
  v1::SynthesizeResponse response;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(
      R"(header {
        model_name: "dancer" model_version: 1 unit: LENGTH_UNIT_METRES up_axis: UP_AXIS_Y_UP
        interaction_classes: "kick" interaction_classes: "hug" request_id: "request-1"
        seed: 18446744073709551615 variety: 0.5 candidates: 4 clean_up: CLEAN_UP_ON })",
      &response));
  v1::SynthesisHeader* header = response.mutable_header();
  header->mutable_joint_names()->Assign(leader.joint_names.begin(), leader.joint_names.end());
  header->set_frame_rate_hz(leader.frame_rate_hz);
  header->set_frame_count(static_cast<uint32_t>(leader.frame_count()));
  return response;
}

v1::SynthesizeResponse ChunkFor(const motion::Clip& leader, int first_frame, int frames) {
  const motion::Poses follower = FollowerFor(leader);
  v1::SynthesizeResponse response;
  v1::MotionChunk* chunk = response.mutable_chunk();
  chunk->set_first_frame(static_cast<uint32_t>(first_frame));
  chunk->set_frame_count(static_cast<uint32_t>(frames));
  for (const motion::Vec3& position : follower.frames(first_frame, frames)) {
    for (float value : {position.x, position.y, position.z}) chunk->add_positions(value);
  }
  return response;
}

v1::SynthesizeResponse SummaryFor(const motion::Clip& leader, int chunks) {
  v1::SynthesizeResponse response;
  v1::SynthesisSummary* summary = response.mutable_summary();
  summary->set_frame_count(static_cast<uint32_t>(leader.frame_count()));
  summary->set_chunk_count(static_cast<uint32_t>(chunks));
  summary->set_window_count(2);
  summary->set_queue_seconds(0.25);
  summary->set_compute_seconds(0.5);
  return response;
}

std::vector<v1::SynthesizeResponse> ReplyFor(const motion::Clip& leader, int chunk_frames) {
  std::vector<v1::SynthesizeResponse> reply = {HeaderFor(leader)};
  int chunks = 0;
  for (int frame = 0; frame < leader.frame_count(); frame += chunk_frames) {
    reply.push_back(ChunkFor(leader, frame, std::min(chunk_frames, leader.frame_count() - frame)));
    ++chunks;
  }
  reply.push_back(SummaryFor(leader, chunks));
  return reply;
}

absl::Status ServiceError(absl::StatusCode code, const std::string& message, absl::Duration delay) {
  absl::Status status(code, message);
  rpc::v1::ErrorInfo info;
  info.set_reason("TEST_REASON");
  info.set_domain("duet.v1");
  status.SetPayload("type.googleapis.com/google.rpc.ErrorInfo",
                    absl::Cord(info.SerializeAsString()));
  if (delay == absl::InfiniteDuration()) return status;
  rpc::v1::RetryInfo retry;
  retry.mutable_retry_delay()->set_seconds(absl::ToInt64Seconds(delay));
  retry.mutable_retry_delay()->set_nanos(
      static_cast<int32_t>(absl::ToInt64Nanoseconds(delay % absl::Seconds(1))));
  status.SetPayload("type.googleapis.com/google.rpc.RetryInfo",
                    absl::Cord(retry.SerializeAsString()));
  return status;
}

}  // namespace duet::test
