#include "client/internal/proto_conversion.h"

#include <google/protobuf/text_format.h>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/client/support/replies.h"
#include "tests/support/matchers.h"

namespace duet::client::internal {
namespace {

using test::ThreeJointLeader;

// In the order of the fields' numbers.
constexpr char kEveryField[] =
    "model { name: \"dancer\" version: 3 } "
    "label_keyframes { label_vector { weights { interaction_class: \"kick\" weight: 1 } } } "
    "label_keyframes { frame: 1 label_vector { weights { interaction_class: \"hug\" weight: 1 } } "
    "} "
    "follower_start { root_position { x: 1 y: 2 z: 3 } } chunk_frames: 8 priority: PRIORITY_BULK "
    "partner_direction { x: -1 y: 0.25 z: 0.5 } seed: 18446744073709551615 variety: 0.25 "
    "clean_up: CLEAN_UP_OFF candidates: 4 reply_rotations: true up { x: 0.25 y: 1 z: -0.5 } "
    "constraints { joint_name: \"hand\" frame: 1 position { x: 0.5 y: 1 z: -2 } softness: 0.25 } "
    "constraints { joint_name: \"head\" position { y: 1.5 } } reaction: 1.5";

SynthesisRequest GoodRequest() {
  SynthesisRequest request;
  request.leader = ThreeJointLeader(2);
  request.weights = {{"kick", 1.0f}, {"hug", -0.5f}};
  return request;
}

// The wire's message without the leader, as text.
std::string Wire(const SynthesisRequest& request) {
  absl::StatusOr<v1::SynthesizeRequest> wire = ToProto(request);
  EXPECT_THAT(wire, IsOk());
  if (!wire.ok()) return "";
  wire->clear_leader();
  return wire->ShortDebugString();
}

TEST(SynthesizeRequestTest, LeaderIsSentInMetresYUp) {
  const absl::StatusOr<v1::SynthesizeRequest> wire = ToProto(GoodRequest());
  ASSERT_THAT(wire, IsOk());
  const v1::Motion& leader = wire->leader();
  EXPECT_THAT(leader.joint_names(), ElementsAre("root", "left", "right"));
  EXPECT_EQ(leader.frame_rate_hz(), 30);
  EXPECT_EQ(leader.unit(), v1::LENGTH_UNIT_METRES);
  EXPECT_EQ(leader.up_axis(), v1::UP_AXIS_Y_UP);
  EXPECT_EQ(leader.frame_count(), 2u);
  ASSERT_EQ(leader.positions_size(), 18);
  EXPECT_EQ(leader.positions(16), 2.5f);  // y of the last joint of the last frame
}

TEST(SynthesizeRequestTest, AbsentFieldsAreNotSent) {
  EXPECT_EQ(Wire(GoodRequest()),
            "model { } label_vector { weights { interaction_class: \"kick\" weight: 1 } "
            "weights { interaction_class: \"hug\" weight: -0.5 } } "
            "priority: PRIORITY_INTERACTIVE variety: 1 candidates: 1 reaction: 1");
}

TEST(SynthesizeRequestTest, EveryFieldIsSent) {
  SynthesisRequest request;
  request.leader = ThreeJointLeader(2);
  request.keyframes = {{0, {{"kick", 1}}}, {1, {{"hug", 1}}}};
  request.follower_start = motion::Vec3{1, 2, 3};
  request.partner_direction = motion::Vec3{-1, 0.25f, 0.5f};
  request.up = motion::Vec3{0.25f, 1, -0.5f};
  request.seed = 18446744073709551615u;
  request.variety = 0.25f;
  request.reaction = 1.5f;
  request.candidates = 4;
  request.clean_up = false;
  request.rotations = true;
  request.chunk_frames = 8;
  request.priority = Priority::kBulk;
  request.model = {"dancer", 3, ""};
  request.constraints = {{"hand", 1, {0.5f, 1, -2}, 0.25f}, {"head", 0, {0, 1.5f, 0}}};
  EXPECT_EQ(Wire(request), kEveryField);
  request.clean_up = true;
  EXPECT_EQ(ToProto(request)->clean_up(), v1::CLEAN_UP_ON);
  request.follower_start = std::vector<motion::Vec3>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  request.model = {"dancer", std::nullopt, "canary"};
  const absl::StatusOr<v1::SynthesizeRequest> wire = ToProto(request);
  ASSERT_THAT(wire, IsOk());
  EXPECT_THAT(wire->follower_start().pose().positions(), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_EQ(wire->model().version_label(), "canary");
}

// What the wire could not carry is refused here, naming the field; the rest is the server's.
TEST(SynthesizeRequestTest, ValuesThatTheProtoCannotHoldAreRejected) {
  const struct {
    const char* message;
    void (*spoil)(SynthesisRequest*);
  } cases[] = {
      {"leader.joint_names: expected", [](SynthesisRequest* r) { r->leader.joint_names.clear(); }},
      {"leader.positions: expected a multiple of 3",
       [](SynthesisRequest* r) {
         r->leader.poses = motion::Poses(3, std::vector<motion::Vec3>(5));
       }},
      {"leader.positions: expected poses of the",
       [](SynthesisRequest* r) { r->leader.poses = motion::Poses(3, 5); }},
      {"label_keyframes[0].frame: expected 0 or more, got -1",
       [](SynthesisRequest* r) {
         r->keyframes.push_back({-1, {{"kick", 1}}});
       }},
      {"chunk_frames: expected 1 or more, got -8",
       [](SynthesisRequest* r) { r->chunk_frames = -8; }},
      {"constraints[0].frame: expected 0 or more, got -1",
       [](SynthesisRequest* r) {
         r->constraints.push_back({"head", -1, {}});
       }},
      {"candidates: expected 1 or more, got 0", [](SynthesisRequest* r) { r->candidates = 0; }},
      {"model.version: expected 1 or more, got 0",
       [](SynthesisRequest* r) { r->model.version = 0; }},
      {"got both: 1 and \"canary\"", [](SynthesisRequest* r) {
         r->model = {"dancer", 1, "canary"};
       }}};
  for (const auto& [message, spoil] : cases) {
    SynthesisRequest request = GoodRequest();
    spoil(&request);
    EXPECT_THAT(ToProto(request), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(message)));
  }
}

template <typename Message>
Message Parse(const char* text) {
  Message message;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &message)) << text;
  return message;
}

constexpr char kModel[] = R"(
  name: "dancer" version: 2 version_labels: "stable" is_default: true interaction_classes: "kick"
  joint_names: "root" joint_names: "left" joint_names: "right" bones { child_joint: 2 }
  root_joint: "root" frame_rate_hz: 15 window_frames: 46 accepts_follower_start: true samples: true
  description: "A model." terms: "For research only." weights_sha256: "ab12" free_for_all_uses: true)";

TEST(ModelTest, EveryFieldIsRead) {
  const absl::StatusOr<ModelInfo> info = FromProto(Parse<v1::Model>(kModel));
  ASSERT_THAT(info, IsOk());
  EXPECT_EQ(info->name, "dancer");
  EXPECT_EQ(info->version, 2);
  EXPECT_THAT(info->version_labels, ElementsAre("stable"));
  EXPECT_TRUE(info->is_default);
  EXPECT_THAT(info->interaction_classes, ElementsAre("kick"));
  EXPECT_THAT(info->joint_names, ElementsAre("root", "left", "right"));
  EXPECT_THAT(info->bones, ElementsAre(motion::Bone{0, 2}));
  EXPECT_EQ(info->root_joint, "root");
  EXPECT_EQ(info->frame_rate_hz, 15);
  EXPECT_EQ(info->window_frames, 46);
  EXPECT_TRUE(info->accepts_follower_start);
  EXPECT_TRUE(info->samples);
  EXPECT_EQ(info->description, "A model.");
  EXPECT_EQ(info->terms, "For research only.");
  EXPECT_EQ(info->weights_sha256, "ab12");
  EXPECT_TRUE(info->free_for_all_uses);
}

TEST(ModelTest, BoneWithoutAJointIsAnInternalError) {
  auto model = Parse<v1::Model>(kModel);
  model.mutable_bones(0)->set_child_joint(3);
  EXPECT_THAT(
      FromProto(model),
      StatusIs(
          absl::StatusCode::kInternal,
          HasSubstr("model.bones of dancer@2: expected joints 0 to 2, got a bone from 0 to 3")));
}

TEST(RequestLimitsTest, EveryFieldIsRead) {
  const RequestLimits limits = FromProto(Parse<v1::RequestLimits>(
      "min_frame_rate_hz: 1 max_frame_rate_hz: 240 min_frames: 2 max_duration_seconds: 600 "
      "max_chunk_frames: 240 max_label_keyframes: 100 max_abs_weight: 2 max_variety: 1.5 "
      "max_candidates: 16 max_constraints: 64 max_request_bytes: 16777216"));
  EXPECT_EQ(limits.min_frame_rate_hz, 1);
  EXPECT_EQ(limits.max_frame_rate_hz, 240);
  EXPECT_EQ(limits.min_frames, 2);
  EXPECT_EQ(limits.max_duration, absl::Minutes(10));
  EXPECT_EQ(limits.max_chunk_frames, 240);
  EXPECT_EQ(limits.max_keyframes, 100);
  EXPECT_EQ(limits.max_abs_weight, 2);
  EXPECT_EQ(limits.max_variety, 1.5F);
  EXPECT_EQ(limits.max_candidates, 16);
  EXPECT_EQ(limits.max_constraints, 64);
  EXPECT_EQ(limits.max_request_bytes, 16 << 20);
}

}  // namespace
}  // namespace duet::client::internal
