#include "client/internal/proto_conversion.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/client/support/fake_stub.h"
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
  const auto refused = [](void (*spoil)(SynthesisRequest*)) {
    SynthesisRequest request = GoodRequest();
    spoil(&request);
    return ToProto(request).status();
  };
  constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;
  EXPECT_THAT(refused([](SynthesisRequest* r) { r->leader.joint_names.clear(); }),
              StatusIs(kInvalid, HasSubstr("leader.joint_names: expected")));
  EXPECT_THAT(refused([](SynthesisRequest* r) {
                r->leader.poses = motion::Poses(3, std::vector<motion::Vec3>(5));
              }),
              StatusIs(kInvalid, HasSubstr("leader.positions: expected a multiple of 3")));
  EXPECT_THAT(refused([](SynthesisRequest* r) { r->leader.poses = motion::Poses(3, 5); }),
              StatusIs(kInvalid, HasSubstr("leader.positions: expected poses of the")));
  EXPECT_THAT(
      refused([](SynthesisRequest* r) {
        r->keyframes = {{-1, {{"kick", 1}}}};
      }),
      StatusIs(kInvalid, HasSubstr("label_keyframes[0].frame: expected 0 or more, got -1")));
  EXPECT_THAT(refused([](SynthesisRequest* r) { r->chunk_frames = -8; }),
              StatusIs(kInvalid, HasSubstr("chunk_frames: expected 1 or more, got -8")));
  EXPECT_THAT(refused([](SynthesisRequest* r) {
                r->constraints = {{"head", -1, {}}};
              }),
              StatusIs(kInvalid, HasSubstr("constraints[0].frame: expected 0 or more, got -1")));
  EXPECT_THAT(refused([](SynthesisRequest* r) { r->candidates = 0; }),
              StatusIs(kInvalid, HasSubstr("candidates: expected 1 or more, got 0")));
  EXPECT_THAT(refused([](SynthesisRequest* r) { r->model.version = 0; }),
              StatusIs(kInvalid, HasSubstr("model.version: expected 1 or more, got 0")));
  EXPECT_THAT(refused([](SynthesisRequest* r) {
                r->model = {"dancer", 1, "canary"};
              }),
              StatusIs(kInvalid, HasSubstr("got both: 1 and \"canary\"")));
}

v1::Model GoodModel() {
  v1::Model model;
  model.set_name("dancer");
  model.set_version(2);
  model.add_version_labels("stable");
  model.set_is_default(true);
  model.add_interaction_classes("kick");
  for (const char* joint : {"root", "left", "right"}) model.add_joint_names(joint);
  v1::Bone* bone = model.add_bones();
  bone->set_parent_joint(0);
  bone->set_child_joint(2);
  model.set_root_joint("root");
  model.set_frame_rate_hz(15);
  model.set_window_frames(46);
  model.set_accepts_follower_start(true);
  model.set_samples(true);
  model.set_description("A model.");
  model.set_terms("For research only.");
  model.set_weights_sha256("ab12");
  model.set_free_for_all_uses(true);
  return model;
}

TEST(ModelTest, EveryFieldIsRead) {
  const absl::StatusOr<ModelInfo> info = FromProto(GoodModel());
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
  v1::Model model = GoodModel();
  model.mutable_bones(0)->set_child_joint(3);
  EXPECT_THAT(
      FromProto(model),
      StatusIs(
          absl::StatusCode::kInternal,
          HasSubstr("model.bones of dancer@2: expected joints 0 to 2, got a bone from 0 to 3")));
}

TEST(RequestLimitsTest, EveryFieldIsRead) {
  v1::RequestLimits wire;
  wire.set_min_frame_rate_hz(1);
  wire.set_max_frame_rate_hz(240);
  wire.set_min_frames(2);
  wire.set_max_duration_seconds(600);
  wire.set_max_chunk_frames(240);
  wire.set_max_label_keyframes(100);
  wire.set_max_abs_weight(2);
  wire.set_max_variety(1.5F);
  wire.set_max_candidates(16);
  wire.set_max_constraints(64);
  wire.set_max_request_bytes(16 << 20);
  const RequestLimits limits = FromProto(wire);
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
