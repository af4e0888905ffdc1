#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>

#include "server/service/validator.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::AddWeight;
using test::Decode;
using test::Refusal;
using test::SampleRequest;

constexpr int kJoints = 15;
constexpr auto kInvalidArgument = absl::StatusCode::kInvalidArgument;
constexpr auto kFailedPrecondition = absl::StatusCode::kFailedPrecondition;
const float kNan = std::numeric_limits<float>::quiet_NaN();

// A start that resumes at frame 108: 10 frames of the leader from frame 100 on, 8 of the follower.
v1::LiveStart Resumed() {
  const v1::SynthesizeRequest sample = SampleRequest(10);
  v1::LiveStart start;
  *start.mutable_leader() = sample.leader();
  *start.mutable_label_vector() = sample.label_vector();
  start.set_delay_frames(2);
  start.set_plan_frames(30);
  v1::LiveHistory& history = *start.mutable_history();
  history.set_first_frame(100);
  history.set_follower_frame_count(8);
  for (int i = 0; i < 8 * kJoints * 3; ++i) {
    history.add_follower_positions(sample.leader().positions(i));
  }
  return start;
}

v1::LiveStart New() {
  v1::LiveStart start = Resumed();
  start.clear_history();
  start.mutable_leader()->clear_positions();
  start.mutable_leader()->set_frame_count(0);
  return start;
}

absl::StatusOr<ValidatedLiveStart> Validate(
    const v1::LiveStart& start,
    const engine::ModelDescription& model = test::SamplingDescription()) {
  return ValidateLiveStart(start, model, RequestLimits());
}

TEST(ValidateLiveStartTest, NewAndResumedSessions) {
  const absl::StatusOr<ValidatedLiveStart> fresh = Validate(New());
  ASSERT_THAT(fresh, IsOk());
  EXPECT_EQ(fresh->live.frame_rate_hz, 15);
  EXPECT_EQ(fresh->live.delay_frames, 2);
  EXPECT_EQ(fresh->plan_frames, 30);
  EXPECT_EQ(fresh->live.first_frame, 0);
  EXPECT_EQ(fresh->live.leader.frame_count(), 0);
  const v1::LiveStart start = Resumed();
  const absl::StatusOr<ValidatedLiveStart> resumed = Validate(start);
  ASSERT_THAT(resumed, IsOk());
  EXPECT_EQ(resumed->live.first_frame, 100);
  EXPECT_EQ(resumed->live.leader.frame_count(), 10);
  ASSERT_EQ(resumed->live.follower.frame_count(), 8);
  EXPECT_EQ(resumed->live.follower[7][2].y,
            start.history().follower_positions((7 * 15 + 2) * 3 + 1));
}

// The same with rotations: also frame 0 of both motions.
v1::LiveStart ResumedWithRotations() {
  v1::LiveStart start = Resumed();
  start.set_reply_rotations(true);
  for (int i = 0; i < kJoints * 3; ++i) {
    start.mutable_history()->add_rig_leader_positions(start.leader().positions(i));
    start.mutable_history()->add_rig_follower_positions(start.leader().positions(i) + 0.5F);
  }
  return start;
}

TEST(ValidateLiveStartTest, RotationsOfAResumedSessionNeedTheFirstFrameOfBoth) {
  const absl::StatusOr<ValidatedLiveStart> valid = Validate(ResumedWithRotations());
  ASSERT_THAT(valid, IsOk());
  EXPECT_TRUE(valid->rotations);
  ASSERT_EQ(valid->rig_leader.frame_count(), 1);
  ASSERT_EQ(valid->rig_follower.frame_count(), 1);
  EXPECT_EQ(valid->rig_follower[0][3].z, valid->rig_leader[0][3].z + 0.5F);
  EXPECT_FALSE(Validate(Resumed())->rotations);
}

TEST(ValidateLiveStartTest, AHistoryFromFrameZeroHasTheFirstFrames) {
  v1::LiveStart start = Resumed();
  start.set_reply_rotations(true);
  start.mutable_history()->set_first_frame(0);
  const absl::StatusOr<ValidatedLiveStart> valid = Validate(start);
  ASSERT_THAT(valid, IsOk());
  ASSERT_EQ(valid->rig_leader.frame_count(), 1);
  EXPECT_EQ(valid->rig_leader[0][2].y, valid->live.leader[0][2].y);
  ASSERT_EQ(valid->rig_follower.frame_count(), 1);
  EXPECT_EQ(valid->rig_follower[0][2].y, valid->live.follower[0][2].y);
}

TEST(ValidateLiveStartTest, ModelThatDoesNotContinueIsRefused) {
  const Refusal refusal = Decode(Validate(New(), test::FakeDescription()).status());
  EXPECT_EQ(refusal.code, kFailedPrecondition);
  EXPECT_THAT(refusal.Fields(), ElementsAre("start.model"));
  EXPECT_THAT(refusal.Of("start.model"), HasSubstr("answers live"));
}

TEST(ValidateLiveStartTest, KeyframesMayLieBeyondTheLeader) {
  v1::LiveStart start = New();
  start.clear_label_vector();
  for (const uint32_t frame : {0U, 5000U}) {
    v1::LabelKeyframe& keyframe = *start.add_label_keyframes();
    keyframe.set_frame(frame);
    AddWeight(*keyframe.mutable_label_vector(), "hug", 1);
  }
  EXPECT_THAT(Validate(start), IsOk());
  start.mutable_label_keyframes(1)->set_frame(uint32_t{kMaxLiveFrames});
  EXPECT_THAT(Decode(Validate(start).status()).Fields(),
              ElementsAre("start.label_keyframes[1].frame"));
}

TEST(ValidateLiveStartTest, LimitsAreIncluded) {
  v1::LiveStart start = New();
  start.mutable_leader()->set_frame_rate_hz(20);
  start.set_delay_frames(10);  // half a second
  start.set_candidates(16);
  EXPECT_THAT(Validate(start), IsOk());
  start = New();
  *start.mutable_leader() = SampleRequest(150).leader();  // ten seconds
  EXPECT_THAT(Validate(start), IsOk());
  *start.mutable_leader() = SampleRequest(151).leader();
  EXPECT_THAT(Decode(Validate(start).status()).Fields(), ElementsAre("start.leader.frame_count"));
}

// One way to spoil a good message, and the error, which names exactly this field.
template <typename Message>
struct Spoiled {
  std::function<void(Message&)> spoil;
  std::string field;
  std::string description;  // a part of it
};

template <typename Message, std::size_t kCases, typename Validation>
void ExpectRefused(const Spoiled<Message> (&cases)[kCases], const Message& good,
                   const Validation& validate) {
  for (const Spoiled<Message>& one : cases) {
    SCOPED_TRACE(one.field + ": " + one.description);
    Message message = good;
    one.spoil(message);
    const Refusal refusal = Decode(validate(message).status());
    EXPECT_EQ(refusal.code, kInvalidArgument) << refusal.message;
    EXPECT_THAT(refusal.Fields(), ElementsAre(one.field));
    EXPECT_THAT(refusal.Of(one.field), HasSubstr(one.description));
  }
}

// Centimetres that are declared as metres.
void Scale(google::protobuf::RepeatedField<float>* metres) {
  for (float& value : *metres) value *= 100;
}

using Start = v1::LiveStart;

TEST(ValidateLiveStartTest, ErrorNamesFieldExpectedAndActualValue) {
  const Spoiled<Start> cases[] = {
      {[](Start& s) { s.clear_label_vector(); }, "start.label_vector", ""},
      {[](Start& s) { s.mutable_leader()->set_frame_rate_hz(241); }, "start.leader.frame_rate_hz",
       "got 241"},
      {[](Start& s) { s.mutable_leader()->add_positions(0); }, "start.leader.positions", "got 451"},
      {[](Start& s) { s.set_candidates(17); }, "start.candidates", "17"},
      {[](Start& s) { s.set_delay_frames(11); }, "start.delay_frames", "expected 0 to 10, got 11"},
      {[](Start& s) { s.set_delay_frames(8); }, "start.delay_frames",
       "expected at most 0.5 s, got 8 frames"},
      {[](Start& s) { s.set_plan_frames(31); }, "start.plan_frames", "expected 0 to 30, got 31"},
      {[](Start& s) { s.mutable_follower_start()->mutable_root_position()->set_x(1); },
       "start.follower_start", "no value together with history"},
      {[](Start& s) { s.mutable_history()->set_first_frame(uint32_t{kMaxLiveFrames}); },
       "start.history.first_frame", "less than 1073741824"},
      {[](Start& s) { s.mutable_history()->clear_follower_frame_count(); },
       "start.history.follower_frame_count", "expected 1 to 10, the frames"},
      {[](Start& s) {
         s.mutable_leader()->clear_positions();
         s.mutable_leader()->set_frame_count(0);
       },
       "start.leader.frame_count", "expected the leader's frames from"},
      {[](Start& s) { s.mutable_history()->set_follower_frame_count(11); },
       "start.history.follower_frame_count", "got 11"},
      {[](Start& s) { s.mutable_history()->add_follower_positions(0); },
       "start.history.follower_positions", "expected 360 values (8 frames x 15"},
      {[](Start& s) { Scale(s.mutable_history()->mutable_follower_positions()); },
       "start.history.follower_positions", "the size of a person"},
  };
  ExpectRefused(cases, Resumed(), [](const Start& start) { return Validate(start); });
}

TEST(ValidateLiveStartTest, ErrorNamesFieldsOfRotations) {
  const Spoiled<Start> cases[] = {
      {[](Start& s) { s.mutable_history()->clear_rig_leader_positions(); },
       "start.history.rig_leader_positions", "expected 45 values"},
      {[](Start& s) { s.mutable_history()->add_rig_follower_positions(0); },
       "start.history.rig_follower_positions", "got 46"},
      {[](Start& s) { Scale(s.mutable_history()->mutable_rig_leader_positions()); },
       "start.history.rig_leader_positions", "the size of a person"},
      {[](Start& s) {
         s = New();
         s.set_reply_rotations(true);
         s.mutable_leader()->set_unit(v1::LENGTH_UNIT_SBU_NORMALISED);
         s.mutable_leader()->set_up_axis(v1::UP_AXIS_Y_DOWN);
       },
       "start.reply_rotations", "LENGTH_UNIT_METRES"},
  };
  ExpectRefused(cases, ResumedWithRotations(), [](const Start& start) { return Validate(start); });
}

using Frames = v1::LeaderFrames;

Frames GoodFrames(int count = 4) {
  Frames frames;
  frames.set_first_frame(12);
  frames.set_frame_count(static_cast<uint32_t>(count));
  *frames.mutable_positions() = SampleRequest(count).leader().positions();
  return frames;
}

absl::StatusOr<motion::Poses> Read(const Frames& frames) {
  return ReadLeaderFrames(frames, Validate(New())->reply, test::FakeDescription(), RequestLimits(),
                          /*check_size=*/false);
}

TEST(ReadLeaderFramesTest, ErrorNamesFieldExpectedAndActualValue) {
  const Spoiled<Frames> cases[] = {
      {[](Frames& f) {
         f.clear_frame_count();
         f.clear_positions();
       },
       "frames.frame_count", "expected 1 to 150, got 0"},
      {[](Frames& f) { f = GoodFrames(151); }, "frames.frame_count", "got 151"},
      {[](Frames& f) { f.set_first_frame(uint32_t{kMaxLiveFrames}); }, "frames.first_frame",
       "less than 1073741824"},
      {[](Frames& f) { f.mutable_positions()->RemoveLast(); }, "frames.positions",
       "expected 180 values (4 frames x 15 joints x 3), got 179"},
      {[](Frames& f) { f.set_positions(50, kNan); }, "frames.positions[50]", "finite"},
  };
  ExpectRefused(cases, GoodFrames(), [](const Frames& frames) { return Read(frames); });
  EXPECT_EQ(Read(GoodFrames(150))->frame_count(), 150);
}

using Change = v1::LabelChange;

constexpr int kNext = 40;

absl::StatusOr<ValidatedLabelChange> Read(const Change& change) {
  return ReadLabelChange(change, kNext, 15, test::SamplingDescription(), RequestLimits());
}

Change GoodChange() {
  Change change;
  AddWeight(*change.mutable_label_vector(), "kick", -0.5F);
  return change;
}

TEST(ReadLabelChangeTest, DefaultsToTheNextFrameAndIncludesItsLimits) {
  Change change = GoodChange();
  absl::StatusOr<ValidatedLabelChange> valid = Read(change);
  ASSERT_THAT(valid, IsOk());
  EXPECT_EQ(valid->frame, kNext);
  EXPECT_EQ(valid->ease_frames, 0);
  EXPECT_EQ(*std::min_element(valid->weights.begin(), valid->weights.end()), -0.5F);
  change.set_frame(kMaxLiveFrames - 1);
  change.set_ease_frames(150);
  valid = Read(change);
  ASSERT_THAT(valid, IsOk());
  EXPECT_EQ(valid->ease_frames, 150);
}

TEST(ReadLabelChangeTest, ErrorNamesFieldExpectedAndActualValue) {
  const Spoiled<Change> cases[] = {
      {[](Change& c) { c.set_frame(kNext - 1); }, "label_change.frame",
       "expected at least 40, the first frame that is not final"},
      {[](Change& c) { c.set_ease_frames(151); }, "label_change.ease_frames",
       "expected at most 150"},
      {[](Change& c) { c.clear_label_vector(); }, "label_change.label_vector.weights",
       "at least one"},
      {[](Change& c) { AddWeight(*c.mutable_label_vector(), "tango", 1); },
       "label_change.label_vector.weights[1].interaction_class", "tango"},
      {[](Change& c) { c.mutable_label_vector()->mutable_weights(0)->set_weight(2.5F); },
       "label_change.label_vector.weights[0].weight", "2.5"},
  };
  ExpectRefused(cases, GoodChange(), [](const Change& change) { return Read(change); });
}

}  // namespace
}  // namespace duet::server::service
