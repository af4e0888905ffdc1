#include "server/service/validator.h"

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/engine/windows.h"
#include "model/motion/levelling.h"
#include "server/common/error_details.h"
#include "server/service/refusals.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::AddWeight;
using test::Decode;
using test::FakeDescription;
using test::Refusal;
using test::SampleRequest;

constexpr int kJoints = 15;
constexpr auto kInvalidArgument = absl::StatusCode::kInvalidArgument;
constexpr auto kFailedPrecondition = absl::StatusCode::kFailedPrecondition;
const float kNan = std::numeric_limits<float>::quiet_NaN();

absl::StatusOr<ValidatedRequest> Validate(
    const v1::SynthesizeRequest& request,
    const engine::ModelDescription& model = FakeDescription()) {
  return ValidateRequest(request, model, RequestLimits());
}

void SetRoot(v1::SynthesizeRequest& request, float x, float y, float z) {
  v1::Point& root = *request.mutable_follower_start()->mutable_root_position();
  root.set_x(x);
  root.set_y(y);
  root.set_z(z);
}

void SetDirection(v1::SynthesizeRequest& request, float x, float y, float z) {
  v1::Direction& direction = *request.mutable_partner_direction();
  direction.set_x(x);
  direction.set_y(y);
  direction.set_z(z);
}

void SetVertical(v1::SynthesizeRequest& request, float x, float y, float z) {
  v1::Direction& up = *request.mutable_up();
  up.set_x(x);
  up.set_y(y);
  up.set_z(z);
}

v1::JointConstraint& AddConstraint(v1::SynthesizeRequest& request, const std::string& joint,
                                   uint32_t frame, float x, float y, float z) {
  v1::JointConstraint& constraint = *request.add_constraints();
  constraint.set_joint_name(joint);
  constraint.set_frame(frame);
  constraint.mutable_position()->set_x(x);
  constraint.mutable_position()->set_y(y);
  constraint.mutable_position()->set_z(z);
  return constraint;
}

using Request = v1::SynthesizeRequest;
using Spoil = std::function<void(Request&)>;

void Scale(Request& request, float factor) {
  for (float& value : *request.mutable_leader()->mutable_positions()) value *= factor;
}

// Merges a text into the request: sets fields, and adds to repeated ones.
Spoil Text(const std::string& text) {
  return [text](Request& request) {
    ASSERT_TRUE(google::protobuf::TextFormat::MergeFromString(text, &request)) << text;
  };
}
// The text `count` times.
Spoil Times(int count, const std::string& text) {
  return [=](Request& request) {
    Request added;
    Text(text)(added);
    for (int i = 0; i < count; ++i) request.MergeFrom(added);
  };
}
Spoil Position(int index, float value) {
  return [=](Request& request) { request.mutable_leader()->set_positions(index, value); };
}
// Leaders of another number of joints.
Spoil MoreJoints(const std::string& name) {
  return [name](Request& request) {
    request.mutable_leader()->add_joint_names(name);
    for (int i = 0; i < 40 * 3; ++i) request.mutable_leader()->add_positions(0);
  };
}
Spoil Keyframes(int count, const std::string& text) {
  return [=](Request& request) {
    request.clear_label_vector();
    for (int i = 0; i < count; ++i) Text(text)(request);
  };
}
Spoil Pose(int values, float last) {
  return [=](Request& request) {
    auto* positions = request.mutable_follower_start()->mutable_pose()->mutable_positions();
    positions->Resize(values, 0);
    positions->Set(values - 1, last);
  };
}

constexpr char kSbu[] = "leader { unit: LENGTH_UNIT_SBU_NORMALISED up_axis: UP_AXIS_Y_DOWN }";
constexpr char kHug[] =
    "label_keyframes { frame: 20 label_vector {"
    "  weights { interaction_class: 'hug' weight: 0.5 } } }";

// A good request is spoiled, and the error names exactly this field.
const struct {
  Spoil spoil;
  std::string field;
  std::string description;  // a part of it
  absl::StatusCode code = kInvalidArgument;
} kSpoiled[] = {
    {Position(17, kNan), "leader.positions[17]", "expected a finite number, got nan"},
    {[](Request& r) { Scale(r, 100); }, "leader.positions", "m from the middle), got 4"},
    {[](Request& r) { Scale(r, 0); }, "leader.positions",
     "m from the middle), got all joints in one point in every frame"},
    {Text("leader { unit: LENGTH_UNIT_MILLIMETRES }"), "leader.positions", "check leader.unit"},
    {Text("leader { positions: 1 }"), "leader.positions",
     "expected 1800 values (40 frames x 15 joints x 3), got 1801"},
    {[](Request& r) {
       r.mutable_leader()->set_frame_count(1);
       r.mutable_leader()->mutable_positions()->Truncate(kJoints * 3);
     },
     "leader.frame_count", "expected at least 2, got 1"},
    {Text("leader { frame_rate_hz: 0 }"), "leader.frame_rate_hz",
     "expected 1 to 240 frames per second, got 0"},
    {Text("leader { frame_rate_hz: nan }"), "leader.frame_rate_hz",
     "expected 1 to 240 frames per second, got nan"},
    {Text("leader { unit: 0 }"), "leader.unit",
     "or LENGTH_UNIT_SBU_NORMALISED, got LENGTH_UNIT_UNSPECIFIED"},
    {[](Request& r) { r.mutable_leader()->set_unit(static_cast<v1::LengthUnit>(17)); },
     "leader.unit", "or LENGTH_UNIT_SBU_NORMALISED, got 17"},
    {Text("leader { up_axis: 0 }"), "leader.up_axis", "or UP_AXIS_Y_DOWN, got UP_AXIS_UNSPECIFIED"},
    {Text("leader { unit: LENGTH_UNIT_SBU_NORMALISED }"), "leader.up_axis",
     "expected UP_AXIS_Y_DOWN with LENGTH_UNIT_SBU_NORMALISED, got UP_AXIS_Y_UP"},
    {Position(4, -20000), "leader.positions[3..5]",
     "expected at most 10000 m from the origin along each axis"},
    {[](Request& r) {
       Text(kSbu)(r);
       Position(3, 3e38F)(r);  // overflows
     },
     "leader.positions[3..5]", "expected at most 10000 m from the origin along each axis"},

    {[](Request& r) {
       r.mutable_leader()->mutable_joint_names()->RemoveLast();
       r.mutable_leader()->mutable_positions()->Truncate(40 * 14 * 3);
     },
     "leader.joint_names", "expected all 15 joints of model fake, got none for right_foot",
     kFailedPrecondition},
    {[](Request& r) {
       r.mutable_leader()->clear_joint_names();
       r.mutable_leader()->clear_positions();
     },
     "leader.joint_names", "got none for head, neck, torso", kFailedPrecondition},
    {MoreJoints("tail"), "leader.joint_names[15]", "right_foot), got \"tail\"",
     kFailedPrecondition},
    {MoreJoints("head"), "leader.joint_names[15]", "got \"head\" again after joint_names[0]",
     kFailedPrecondition},
    {[](Request& r) {
       for (int i = 0; i < 100000; ++i) r.mutable_leader()->add_joint_names("x");
       r.mutable_leader()->mutable_positions()->Resize(40 * 100015 * 3, 0);
     },
     "leader.joint_names", "expected the 15 joints of model fake, got 100015 names",
     kFailedPrecondition},

    {[](Request& r) { r.clear_label_vector(); }, "label_vector",
     "expected label_vector or label_keyframes, got neither"},
    {Text(kHug), "label_keyframes", "expected label_vector or label_keyframes, got both"},
    {[](Request& r) { r.mutable_label_vector()->clear_weights(); }, "label_vector.weights",
     "expected a weight for at least one of kick"},
    {Text("label_vector { weights { interaction_class: 'dance' } }"),
     "label_vector.weights[1].interaction_class", ", got \"dance\""},
    {Text("label_vector { weights { interaction_class: 'kick' } }"),
     "label_vector.weights[1].interaction_class", "got \"kick\" again after weights[0]"},
    {Text("label_vector { weights { interaction_class: 'hug' weight: 2.5 } }"),
     "label_vector.weights[1].weight", "expected a finite value in [-2, 2], got 2.5"},
    {Times(1000, "label_vector { weights { interaction_class: 'x' } }"), "label_vector.weights",
     "expected at most one weight for each of 6 classes, got 1001"},
    {Keyframes(1, std::string(kHug).replace(24, 2, "40")), "label_keyframes[0].frame",
     "expected less than 40, the number of frames, got 40"},
    {Keyframes(2, kHug), "label_keyframes[1].frame",
     "expected more than the previous keyframe's 20, got 20"},
    {Keyframes(1, "label_keyframes {}"), "label_keyframes[0].label_vector.weights", "got none"},
    {Keyframes(4097, kHug), "label_keyframes", "expected at most 4096, got 4097"},

    {Pose(45, 0), "follower_start.pose.positions", "got all joints in one point in every frame"},
    {Text("follower_start {}"), "follower_start.start",
     "expected root_position or pose, got neither"},
    {Pose(1, 1), "follower_start.pose.positions", "expected 45 values (15 joints x 3), got 1"},
    {Pose(45, kNan), "follower_start.pose.positions[44]", "expected a finite number, got nan"},

    {Text("chunk_frames: 0"), "chunk_frames", "expected 1 to 240, got 0"},
    {[](Request& r) { r.set_priority(static_cast<v1::Priority>(9)); }, "priority",
     "or no value, got 9"},
    {Text("reply_joint_names: 'tail'"), "reply_joint_names[0]",
     "expected one of leader.joint_names, got \"tail\""},
    {Times(2, "reply_joint_names: 'head'"), "reply_joint_names[1]",
     "got \"head\" again after reply_joint_names[0]"},
    {Times(16, "reply_joint_names: 'head'"), "reply_joint_names",
     "expected at most the 15 names of leader.joint_names, got 16"},
    {Text(std::string("reply_rotations: true ") + kSbu), "reply_rotations",
     "has no rotations, got LENGTH_UNIT_SBU_NORMALISED"},
    {Text("reply_rotations: true reply_joint_names: 'head'"), "reply_rotations",
     "expected no reply_joint_names: a rig needs every joint, got 1"},
    {Text("variety: nan"), "variety", "expected a finite value in [0, 2], got nan"},
    {Text("reaction: -0.5"), "reaction", "expected a finite value in [0, 2], got -0.5"},
    {Text("candidates: 4294967295"), "candidates", "expected 1 to 16, got 4294967295"},
    {[](Request& r) { r.set_clean_up(static_cast<v1::CleanUp>(9)); }, "clean_up",
     "expected CLEAN_UP_ON, CLEAN_UP_OFF or no value, got 9"},
    {Text("partner_direction {}"), "partner_direction",
     "expected a direction that is neither vertical nor of length 0, got (0, 0, 0)"},
    {Text("partner_direction { x: 1e-6 y: -3 z: 1e-6 }"), "partner_direction",
     "expected a direction that is neither vertical"},
    {Text("partner_direction { x: nan z: 1 }"), "partner_direction[0]",
     "expected a finite number, got nan"},
    {Text("up {}"), "up",
     "expected a direction of any length but 0, less than 45 degrees from UP_AXIS_Y_UP, got (0, "
     "0, 0)"},
    {Text("up { y: 2 z: 1 } partner_direction { y: 4 z: 2 }"), "partner_direction",
     "neither vertical nor of length 0, got (0, 4, 2)"},

    {Text("constraints { joint_name: 'left_wing' position { y: 1 } }"), "constraints[0].joint_name",
     "a joint of model fake (head, neck, torso, left_shoulder", kFailedPrecondition},
    {Text("constraints { joint_name: 'head' frame: 40 position { y: 1 } }"), "constraints[0].frame",
     "expected less than the 40 frames of leader, got 40"},
    {Text("constraints { joint_name: 'head' }"), "constraints[0].position",
     "expected a point, got none"},
    {Text("constraints { joint_name: 'head' position { y: nan } }"), "constraints[0].position",
     "expected finite numbers, got (0, nan, 0)"},
    {Text("constraints { joint_name: 'head' position { x: 100 y: 1600 } }"),
     "constraints[0].position", "at most 20 m from the leader in this frame"},
    {Text("constraints { joint_name: 'head' position { y: 1 } softness: nan }"),
     "constraints[0].softness", "expected a finite value in [0, 1], got nan"},
    {Times(2, "constraints { joint_name: 'head' frame: 3 position { y: 1 } }"), "constraints[1]",
     "each joint at most once in a frame, got \"head\" in frame 3 again after constraints[0]"},
    {Times(65, "constraints {}"), "constraints", "expected at most 64, got 65"},
};

TEST(ValidateRequestTest, ErrorNamesFieldExpectedAndActualValue) {
  for (const auto& [spoil, field, description, code] : kSpoiled) {
    SCOPED_TRACE(absl::StrCat(field, ": ", description));
    Request request = SampleRequest();
    spoil(request);
    const Refusal refusal = Decode(Validate(request).status());
    EXPECT_EQ(refusal.code, code) << refusal.message;
    EXPECT_EQ(refusal.reason, code == kInvalidArgument ? "INVALID_REQUEST" : "MODEL_MISMATCH");
    EXPECT_THAT(refusal.Fields(), ElementsAre(field)) << "exactly this field";
    EXPECT_THAT(refusal.Of(field), HasSubstr(description));
    EXPECT_THAT(refusal.message, HasSubstr(field));
  }
}

TEST(ValidateRequestTest, RejectionOfAnEmptyRequestNamesEveryMissingField) {
  const Refusal refusal = Decode(Validate(v1::SynthesizeRequest()).status());
  EXPECT_EQ(refusal.code, kInvalidArgument);
  EXPECT_THAT(refusal.Fields(), ElementsAre("leader", "label_vector"));
}

TEST(ValidateRequestTest, NamesEverythingThatIsWrongAtOnce) {
  v1::SynthesizeRequest request = SampleRequest();
  request.mutable_leader()->set_positions(17, kNan);
  request.mutable_leader()->set_frame_rate_hz(1000);
  request.mutable_leader()->clear_unit();
  request.mutable_leader()->set_joint_names(0, "hat");
  AddWeight(*request.mutable_label_vector(), "dance", 7);
  request.set_chunk_frames(0);
  request.add_reply_joint_names("tail");
  const Refusal refusal = Decode(Validate(request).status());
  EXPECT_EQ(refusal.code, kInvalidArgument);
  EXPECT_THAT(
      refusal.Fields(),
      ElementsAre("leader.joint_names[0]", "leader.joint_names", "leader.frame_rate_hz",
                  "leader.unit", "leader.positions[17]",
                  "label_vector.weights[1].interaction_class", "label_vector.weights[1].weight",
                  "reply_joint_names[0]", "chunk_frames"));
}

TEST(ValidateRequestTest, NamesTheFirstBadValuesAndCountsAll) {
  v1::SynthesizeRequest request = SampleRequest();
  for (int i = 100; i < 900; ++i) request.mutable_leader()->set_positions(i, kNan);
  const Refusal refusal = Decode(Validate(request).status());
  EXPECT_THAT(refusal.Fields(), ElementsAre("leader.positions[100]", "leader.positions[101]",
                                            "leader.positions[102]", "leader.positions"));
  EXPECT_THAT(refusal.Of("leader.positions"),
              HasSubstr("got 800 of 1800 values that are not finite"));
}

TEST(ValidateRequestTest, AcceptsTwoFramesToTenMinutes) {
  EXPECT_THAT(Validate(SampleRequest(2)), IsOk());
  EXPECT_THAT(Validate(SampleRequest(9000)), IsOk());
  EXPECT_THAT(Decode(Validate(SampleRequest(9001)).status()).Of("leader.frame_count"),
              AllOf(HasSubstr("expected a duration of at most 600 s"),
                    HasSubstr("got 9001 frames, 600.067 s")));
}

TEST(ValidateRequestTest, RejectsAFollowerStartThatTheModelDoesNotAccept) {
  engine::ModelDescription model = FakeDescription();
  model.accepts_follower_start = false;
  v1::SynthesizeRequest request = SampleRequest();
  SetRoot(request, 0, 1, 1);
  const Refusal refusal = Decode(Validate(request, model).status());
  EXPECT_EQ(refusal.code, kFailedPrecondition);
  EXPECT_THAT(refusal.Of("follower_start"),
              HasSubstr("model fake version 1, which does not accept it"));
}

TEST(ValidateRequestTest, EscapesAndTruncatesJointNames) {
  v1::SynthesizeRequest request = SampleRequest();
  request.mutable_leader()->set_joint_names(0, "a\nb" + std::string(100000, 'x'));
  const Refusal refusal = Decode(Validate(request).status());
  EXPECT_THAT(refusal.Of("leader.joint_names[0]"), HasSubstr("got \"a\\nbxxx"));
  EXPECT_LT(refusal.message.size(), 1000u);
}

TEST(ValidateRequestTest, RejectsManyJointNamesInLinearTime) {
  // Quadratic work on this would outlast the test's time limit.
  v1::SynthesizeRequest request;
  for (int i = 0; i < 300000; ++i) {
    request.mutable_leader()->add_joint_names(absl::StrCat("joint", i));
    request.add_reply_joint_names(absl::StrCat("joint", 300000 - i));
  }
  EXPECT_THAT(Validate(request), StatusIs(kInvalidArgument, HasSubstr("300000 names")));
}

TEST(ValidateRequestTest, FillsInDefaults) {
  const absl::StatusOr<ValidatedRequest> request = Validate(SampleRequest());
  ASSERT_THAT(request, IsOk());
  EXPECT_EQ(request->chunk_frames, 30);
  EXPECT_EQ(request->priority, batching::Priority::kInteractive);
  EXPECT_FALSE(request->clip.start.has_value());
  EXPECT_FALSE(request->clip.partner_direction.has_value());
  EXPECT_EQ(request->clip.options.sampling.seed,
            engine::LeaderSeed(request->clip.leader, request->clip.frame_rate_hz, {}));
  EXPECT_EQ(request->clip.options.sampling.variety, 1);
  EXPECT_EQ(request->clip.options.sampling.reaction, 1);
  EXPECT_EQ(request->clip.options.sampling.candidates, 1);
  EXPECT_EQ(request->clip.options.clean_up, std::nullopt);
  EXPECT_EQ(request->reply.joint_names, FakeDescription().skeleton.joint_names);
  EXPECT_FALSE(request->reply.rig.has_value());
}

TEST(ValidateRequestTest, TakesOverWhatIsGiven) {
  v1::SynthesizeRequest request = SampleRequest();
  request.set_chunk_frames(7);
  request.set_priority(v1::PRIORITY_BULK);
  request.set_seed(std::numeric_limits<uint64_t>::max());
  request.set_variety(0);
  request.set_reaction(1.5F);
  request.set_candidates(16);
  const absl::StatusOr<ValidatedRequest> validated = Validate(request);
  ASSERT_THAT(validated, IsOk());
  EXPECT_EQ(validated->chunk_frames, 7);
  EXPECT_EQ(validated->priority, batching::Priority::kBulk);
  EXPECT_EQ(validated->clip.frame_rate_hz, 15);
  EXPECT_EQ(validated->clip.options.sampling.seed, std::numeric_limits<uint64_t>::max());
  EXPECT_EQ(validated->clip.options.sampling.variety, 0);
  EXPECT_EQ(validated->clip.options.sampling.reaction, 1.5F);
  EXPECT_EQ(validated->clip.options.sampling.candidates, 16);
}

// Writes the leader's joints in reverse order.
void ReverseJoints(v1::Motion& leader) {
  const v1::Motion original = leader;
  for (int joint = 0; joint < kJoints; ++joint) {
    leader.set_joint_names(joint, original.joint_names(kJoints - 1 - joint));
    for (uint32_t frame = 0; frame < leader.frame_count(); ++frame) {
      for (int axis = 0; axis < 3; ++axis) {
        const int base = static_cast<int>(frame) * kJoints;
        leader.set_positions((base + joint) * 3 + axis,
                             original.positions((base + kJoints - 1 - joint) * 3 + axis));
      }
    }
  }
}

TEST(ValidateRequestTest, BringsJointsIntoTheModelsOrder) {
  v1::SynthesizeRequest request = SampleRequest();
  const absl::StatusOr<ValidatedRequest> ordered = Validate(request);
  ReverseJoints(*request.mutable_leader());
  const absl::StatusOr<ValidatedRequest> reversed = Validate(request);
  ASSERT_THAT(ordered, IsOk());
  ASSERT_THAT(reversed, IsOk());
  EXPECT_EQ(reversed->clip.leader, ordered->clip.leader);
  EXPECT_EQ(reversed->reply.joint_names.front(), "right_foot");
  EXPECT_EQ(reversed->reply.joints.front(), 14);
}

TEST(ValidateRequestTest, ALeaderWhomTheTrackerLosesIsValid) {
  v1::SynthesizeRequest request = SampleRequest();
  auto& positions = *request.mutable_leader()->mutable_positions();
  for (int i = 3 * kJoints; i < positions.size(); ++i) positions[i] = 0;
  EXPECT_THAT(Validate(request), IsOk()) << "its first frame shows a person";
}

// A request in coordinates whose vertical leans by 10 degrees, of the leader of SampleRequest.
v1::SynthesizeRequest TiltedRequest(const motion::Coordinates& coordinates, v1::LengthUnit unit,
                                    v1::UpAxis up_axis) {
  const motion::Levelling levelling({0.1F, 1, 0.15F}, 0);
  const auto caller = [&](motion::Vec3 level) {
    return FromWorld(coordinates, levelling.Invert(level));
  };
  v1::SynthesizeRequest request = SampleRequest();
  v1::Motion& leader = *request.mutable_leader();
  leader.set_unit(unit);
  leader.set_up_axis(up_axis);
  for (int i = 0; i < leader.positions_size(); i += 3) {
    float* xyz = leader.mutable_positions()->mutable_data() + i;
    const motion::Vec3 position = caller({xyz[0], xyz[1], xyz[2]});
    xyz[0] = position.x, xyz[1] = position.y, xyz[2] = position.z;
  }
  const motion::Vec3 start = caller({1, 2, 3}), origin = caller({0, 0, 0});
  const motion::Vec3 up = caller({0, 1, 0}) - origin, direction = caller({3, 7, 4}) - origin;
  SetRoot(request, start.x, start.y, start.z);
  SetVertical(request, up.x, up.y, up.z);
  SetDirection(request, direction.x, direction.y, direction.z);
  return request;
}

TEST(ValidateRequestTest, LevelsEveryPositionAndDirectionInEveryUnitAndAxis) {
  using motion::LengthUnit;
  using motion::UpAxis;
  const absl::StatusOr<ValidatedRequest> level = Validate(SampleRequest());
  ASSERT_THAT(level, IsOk());
  const struct {
    motion::Coordinates coordinates;
    v1::LengthUnit unit;
    v1::UpAxis axis;
  } cases[] = {
      {{LengthUnit::kMetres, UpAxis::kYUp}, v1::LENGTH_UNIT_METRES, v1::UP_AXIS_Y_UP},
      {{LengthUnit::kMillimetres, UpAxis::kZUp}, v1::LENGTH_UNIT_MILLIMETRES, v1::UP_AXIS_Z_UP},
      {{LengthUnit::kSbuNormalised, UpAxis::kYDown},
       v1::LENGTH_UNIT_SBU_NORMALISED,
       v1::UP_AXIS_Y_DOWN}};
  for (const auto& one : cases) {
    const absl::StatusOr<ValidatedRequest> tilted =
        Validate(TiltedRequest(one.coordinates, one.unit, one.axis));
    ASSERT_THAT(tilted, IsOk());
    for (int i = 0; i < level->clip.leader.frame_count() * kJoints; ++i) {
      const auto at = static_cast<std::size_t>(i);
      ASSERT_LT(Distance(tilted->clip.leader.all()[at], level->clip.leader.all()[at]), 1e-4F) << i;
    }
    EXPECT_LT(Distance(tilted->clip.start->root, {1, 2, 3}), 1e-4F);
    EXPECT_LT(Distance(*tilted->clip.partner_direction, {0.6F, 0, 0.8F}), 1e-4F);
  }
}

TEST(ValidateRequestTest, ReadsAStartPoseInTheLeadersJointOrderAndLevelsIt) {
  v1::SynthesizeRequest request = SampleRequest();
  ReverseJoints(*request.mutable_leader());
  auto* positions = request.mutable_follower_start()->mutable_pose()->mutable_positions();
  for (int joint = 0; joint < kJoints; ++joint) {
    for (const float value : {0.125F * static_cast<float>(joint), 3.0F, 4.0F}) {
      positions->Add(value);
    }
  }
  SetVertical(request, 0, 4, 3);
  const absl::StatusOr<ValidatedRequest> validated = Validate(request);
  ASSERT_THAT(validated, IsOk());
  const engine::FollowerStart& start = *validated->clip.start;
  ASSERT_EQ(start.pose.size(), static_cast<std::size_t>(kJoints));
  EXPECT_LT(Distance(start.pose[0], {1.75F, 4.8F, 1.4F}), 1e-5F);
  EXPECT_LT(Distance(start.pose[14], {0, 4.8F, 1.4F}), 1e-5F);
  EXPECT_EQ(start.root, start.pose[FakeDescription().skeleton.root]);
}

TEST(ValidateRequestTest, ReadsAPartnerDirectionInTheLeadersFrame) {
  v1::SynthesizeRequest request = SampleRequest();
  request.mutable_leader()->set_up_axis(v1::UP_AXIS_Z_UP);
  SetDirection(request, 0, 3e-20F, 1e-20F);
  absl::StatusOr<ValidatedRequest> validated = Validate(request);
  ASSERT_THAT(validated, IsOk());
  EXPECT_LT(Distance(*validated->clip.partner_direction, {0, 0, -1}), 1e-6F);

  SetDirection(request, 1e-4F, 0, 3);  // steep, but it points somewhere
  validated = Validate(request);
  ASSERT_THAT(validated, IsOk());
  EXPECT_LT(Distance(*validated->clip.partner_direction, {1, 0, 0}), 1e-6F);

  request.mutable_leader()->set_unit(v1::LENGTH_UNIT_SBU_NORMALISED);
  request.mutable_leader()->set_up_axis(v1::UP_AXIS_Y_DOWN);
  SetDirection(request, 3e38F, 1, 0);
  validated = Validate(request);
  ASSERT_THAT(validated, IsOk());
  EXPECT_LT(Distance(*validated->clip.partner_direction, {-1, 0, 0}), 1e-6F);
}

TEST(ValidateRequestTest, ReadsLabelsInTheModelsClassOrder) {
  v1::SynthesizeRequest request = SampleRequest();
  AddWeight(*request.mutable_label_vector(), "punch", -0.5F);
  const absl::StatusOr<ValidatedRequest> validated = Validate(request);
  ASSERT_THAT(validated, IsOk());
  std::vector<float> weights(6);
  validated->clip.labels.At(20, weights.data());
  EXPECT_EQ(weights, (std::vector<float>{1, 0, 0, 0, 0, -0.5F}));
}

TEST(Constraints, ArePinsInTheModelsJointsAndLevelMetres) {
  Request request = SampleRequest();
  Scale(request, 1000);
  request.mutable_leader()->set_unit(v1::LENGTH_UNIT_MILLIMETRES);
  request.mutable_leader()->set_up_axis(v1::UP_AXIS_Z_UP);
  AddConstraint(request, "right_hand", 7, 300, -200, 1500).set_softness(0.25F);
  AddConstraint(request, "torso", 39, 0, 0, 1000);
  const auto valid = Validate(request);
  ASSERT_THAT(valid, IsOk());
  const motion::Pins& pins = valid->clip.pins;
  ASSERT_THAT(pins, SizeIs(2));
  EXPECT_EQ(pins[0].joint, 8);
  EXPECT_EQ(pins[0].frame, 7);
  EXPECT_NEAR(Distance(pins[0].position, motion::Vec3{0.3F, 1.5F, 0.2F}), 0, 1e-6);
  EXPECT_EQ(pins[0].softness, 0.25F);
  EXPECT_EQ(pins[1].joint, 2);
  EXPECT_EQ(pins[1].softness, 0);
  SetVertical(request, 0.2F, 0, 1);
  const auto tilted = Validate(request);
  ASSERT_THAT(tilted, IsOk());
  const motion::Vec3 level = motion::Levelling({0.2F, 1, 0}, 0).Apply(pins[0].position);
  EXPECT_NEAR(Distance(tilted->clip.pins[0].position, level), 0, 1e-6);
}

TEST(ViolationsTest, ManyFitIntoTrailersAndAreCounted) {
  Violations violations;
  EXPECT_THAT(violations.ToStatus(), IsOk());
  for (int i = 0; i < 1000; ++i) {
    violations.Malformed(absl::StrCat("field[", i, "]"), "y", std::string(1000, 'x'));
  }
  const grpc::Status status = common::ToGrpcStatus(violations.ToStatus());
  // As base64 and together with the message; clients take 8 KiB of trailers.
  EXPECT_LT(status.error_details().size() * 4 / 3 + status.error_message().size(), 6000u);
  const Refusal refusal = Decode(status);
  EXPECT_EQ(refusal.reason, "INVALID_REQUEST");
  ASSERT_FALSE(refusal.violations.empty());
  EXPECT_EQ(refusal.violations.front().first, "field[0]");
  const std::size_t listed = refusal.violations.size() - 1;
  EXPECT_THAT(refusal.violations.back(),
              Pair("", absl::StrCat(1000 - listed, " further violations are not listed")));
  EXPECT_THAT(refusal.message, HasSubstr("and 998 more"));
}

TEST(Constraints, AnInvalidLeaderDoesNotHideThem) {
  Request request = SampleRequest();
  request.mutable_leader()->clear_unit();
  AddConstraint(request, "head", 400, 0, 1, 0);
  EXPECT_THAT(Decode(Validate(request).status()).Fields(),
              ::testing::UnorderedElementsAre("leader.unit", "constraints[0].frame"));
}

}  // namespace
}  // namespace duet::server::service
