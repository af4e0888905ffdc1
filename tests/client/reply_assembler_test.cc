#include "client/internal/reply_assembler.h"

#include <google/protobuf/text_format.h>

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/client/support/replies.h"
#include "tests/support/matchers.h"

namespace duet::client::internal {
namespace {

using test::ChunkFor;
using test::FollowerFor;
using test::HeaderFor;
using test::ReplyFor;
using test::ServiceError;
using test::ThreeJointLeader;

using Reply = std::vector<v1::SynthesizeResponse>;

class ReplyAssemblerTest : public ::testing::Test {
 protected:
  // Feeds a stream until it is refused, then ends it.
  absl::Status Feed(const Reply& reply, const absl::Status& end = absl::OkStatus()) {
    assembler_.StartStream();
    for (const v1::SynthesizeResponse& response : reply) {
      absl::Status status = assembler_.Accept(response);
      if (!status.ok()) return status;
    }
    return assembler_.EndStream(end);
  }

  // A good reply (header, frames 0-1, frames 2-3, frame 4, summary) with one thing spoilt.
  absl::Status FeedSpoilt(const std::function<void(Reply*)>& spoil) {
    Reply reply = ReplyFor(leader_, 2);
    spoil(&reply);
    return Feed(reply);
  }

  motion::Clip leader_ = ThreeJointLeader(5);
  std::vector<std::pair<int, int>> handed_out_;
  motion::Poses frames_;
  ChunkCallback on_chunk_ = [this](const FollowerChunk& chunk) {
    handed_out_.emplace_back(chunk.first_frame, chunk.poses.frame_count());
    if (frames_.empty()) frames_ = motion::Poses(0, chunk.poses.joint_count());
    frames_.Append(chunk.poses.all());
    return absl::OkStatus();
  };
  ReplyAssembler assembler_{leader_, on_chunk_};
};

TEST_F(ReplyAssemblerTest, AssemblesAValidReply) {
  ASSERT_THAT(Feed(ReplyFor(leader_, 2)), IsOk());
  EXPECT_THAT(handed_out_, ElementsAre(std::pair(0, 2), std::pair(2, 2), std::pair(4, 1)));
  EXPECT_EQ(frames_, FollowerFor(leader_));

  const SynthesisResult result = std::move(assembler_).TakeResult();
  EXPECT_EQ(result.pair.leader.poses, leader_.poses);
  EXPECT_EQ(result.pair.follower.poses, FollowerFor(leader_));
  EXPECT_EQ(result.pair.follower.joint_names, leader_.joint_names);
  EXPECT_EQ(result.pair.follower.frame_rate_hz, 30);
  EXPECT_EQ(result.model_name, "dancer");
  EXPECT_EQ(result.model_version, 1);
  EXPECT_THAT(result.interaction_classes, ElementsAre("kick", "hug"));
  EXPECT_EQ(result.request_id, "request-1");
  EXPECT_EQ(result.seed, 18446744073709551615u);
  EXPECT_EQ(result.variety, 0.5F);
  EXPECT_EQ(result.candidates, 4);
  EXPECT_TRUE(result.cleaned_up);
  EXPECT_FALSE(result.unfamiliarity.has_value());
  EXPECT_FALSE(result.grade.has_value());
  EXPECT_EQ(result.window_count, 2);
  EXPECT_EQ(result.timings.queue, absl::Milliseconds(250));
  EXPECT_EQ(result.timings.compute, absl::Milliseconds(500));
}

// The same reply with a rig of two joints at the leader's; frame f has x = 1 or, if odd, w = 1.
class ReplyWithRotationsTest : public ReplyAssemblerTest {
 protected:
  static void AddRotations(Reply* reply) {
    EXPECT_TRUE(google::protobuf::TextFormat::MergeFromString(
        "rig { name: 'root' parent: -1 } rig { name: 'left' joint: 1 offset { y: 0.5 } }",
        reply->front().mutable_header()));
    for (v1::SynthesizeResponse& response : *reply) {
      if (!response.has_chunk()) continue;
      v1::MotionChunk& chunk = *response.mutable_chunk();
      for (uint32_t i = 0; i < 2 * chunk.frame_count(); ++i) {
        const bool odd = (chunk.first_frame() + i / 2) % 2 == 1;
        for (const float value : {odd ? 0.0F : 1.0F, 0.0F, 0.0F, odd ? 1.0F : 0.0F}) {
          chunk.add_rotations(value);
        }
      }
    }
  }

  absl::Status FeedWithRotations(const std::function<void(Reply*)>& spoil = nullptr) {
    Reply reply = ReplyFor(leader_, 2);
    AddRotations(&reply);
    if (spoil) spoil(&reply);
    rotating_.StartStream();
    for (const v1::SynthesizeResponse& response : reply) {
      absl::Status status = rotating_.Accept(response);
      if (!status.ok()) return status;
    }
    return rotating_.EndStream(absl::OkStatus());
  }

  std::vector<FollowerChunk> chunks_;
  ChunkCallback keep_ = [this](const FollowerChunk& chunk) {
    chunks_.push_back(chunk);
    return absl::OkStatus();
  };
  ReplyAssembler rotating_{leader_, keep_, /*rotations=*/true};
};

TEST_F(ReplyWithRotationsTest, AssemblesThem) {
  ASSERT_THAT(FeedWithRotations(), IsOk());
  ASSERT_EQ(chunks_.size(), 3u);
  ASSERT_TRUE(chunks_[1].rotations.has_value());
  EXPECT_EQ(chunks_[1].rotations->rig[1].name, "left");
  ASSERT_EQ(chunks_[1].rotations->rotations.size(), 4u);
  EXPECT_EQ(chunks_[1].rotations->rotations[0].x, 1);
  EXPECT_EQ(chunks_[1].rotations->rotations[2].w, 1);
  const SynthesisResult result = std::move(rotating_).TakeResult();
  ASSERT_TRUE(result.rotations.has_value());
  EXPECT_EQ(result.rotations->rig.size(), 2u);
  EXPECT_EQ(result.rotations->rig[0].parent, -1);
  EXPECT_EQ(result.rotations->rig[1].parent, 0);
  EXPECT_EQ(result.rotations->rig[1].joint, 1);
  EXPECT_EQ(result.rotations->rig[1].offset, (motion::Vec3{0, 0.5F, 0}));
  EXPECT_EQ(result.rotations->rotations.size(), 10u);
}

TEST_F(ReplyWithRotationsTest, WhatIsNoRigOrNoRotationIsRejected) {
  const auto header = [](Reply* r) { return r->front().mutable_header(); };
  const auto chunk = [](Reply* r) { return (*r)[2].mutable_chunk(); };
  const std::vector<std::pair<std::string, std::function<void(Reply*)>>> breaches = {
      {"header.rig: expected joints", [&](Reply* r) { header(r)->clear_rig(); }},
      {"rig[0].parent: expected -1, got 0",
       [&](Reply* r) { header(r)->mutable_rig(0)->set_parent(0); }},
      {"rig[1].parent: expected 0 to 0",
       [&](Reply* r) { header(r)->mutable_rig(1)->set_parent(1); }},
      {"joint: expected 0 to 2, got 3", [&](Reply* r) { header(r)->mutable_rig(1)->set_joint(3); }},
      {"got \"root\" again", [&](Reply* r) { header(r)->mutable_rig(1)->set_name("root"); }},
      {"rig[1].offset: expected finite values",
       [&](Reply* r) {
         header(r)->mutable_rig(1)->mutable_offset()->set_x(std::numeric_limits<float>::infinity());
       }},
      {"chunk.rotations: expected 16 values for 2 frames, got 17, in the chunk of frame 2",
       [&](Reply* r) { chunk(r)->add_rotations(0); }},
      {"rotations[4..7]: expected a unit quaternion, got norm 0.5",
       [&](Reply* r) { chunk(r)->set_rotations(4, 0.5F); }},
      {"rotations[4..7]",
       [&](Reply* r) { chunk(r)->set_rotations(5, std::numeric_limits<float>::quiet_NaN()); }}};
  for (const auto& [message, spoil] : breaches) {
    EXPECT_THAT(FeedWithRotations(spoil),
                StatusIs(absl::StatusCode::kInternal, HasSubstr(message)));
  }
}

TEST_F(ReplyAssemblerTest, ReadsTheGrade) {
  ASSERT_THAT(FeedSpoilt([](Reply* r) {
                EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(
                    "twisted: 0.25 skating: 0.5 leader_skating: 0.75 overlapping: 1 "
                    "bad_runs { frame_count: 1 } bad_runs { first_frame: 3 frame_count: 2 }",
                    r->back().mutable_summary()->mutable_grade()));
              }),
              IsOk());
  const SynthesisResult result = std::move(assembler_).TakeResult();
  ASSERT_TRUE(result.grade.has_value());
  EXPECT_EQ(result.grade->twisted, 0.25);
  EXPECT_EQ(result.grade->leader_skating, 0.75);
  ASSERT_EQ(result.grade->bad_runs.size(), 2u);
  EXPECT_EQ(result.grade->bad_runs[1].first_frame, 3);
  EXPECT_EQ(result.grade->bad_runs[1].frame_count, 2);
}

TEST_F(ReplyAssemblerTest, WhatRemainsAtTheConstraintsIsReturned) {
  ReplyAssembler assembler(leader_, on_chunk_, /*rotations=*/false, /*constraints=*/2);
  const auto feed = [&](const std::vector<float>& metres) {
    Reply reply = ReplyFor(leader_, 5);
    reply.back().mutable_summary()->mutable_constraint_metres()->Assign(metres.begin(),
                                                                        metres.end());
    assembler.StartStream();
    absl::Status status;
    for (const v1::SynthesizeResponse& response : reply) status.Update(assembler.Accept(response));
    return status;
  };
  constexpr auto kInternal = absl::StatusCode::kInternal;
  EXPECT_THAT(feed({}), StatusIs(kInternal, HasSubstr("expected 2 values, one for each of "
                                                      "constraints, got 0; does the server know")));
  EXPECT_THAT(feed({0.1f}), StatusIs(kInternal, HasSubstr("got 1")));
  ASSERT_THAT(feed({0.1f, 0}), IsOk());
  EXPECT_THAT(std::move(assembler).TakeResult().constraint_metres, ElementsAre(0.1f, 0));
}

TEST_F(ReplyAssemblerTest, EveryContractViolationIsReported) {
  const std::vector<std::pair<std::string, std::function<void(Reply*)>>> breaches = {
      {"a chunk before the header", [](Reply* r) { r->erase(r->begin()); }},
      {"a second header", [](Reply* r) { r->insert(r->begin(), r->front()); }},
      {"header.joint_names",
       [](Reply* r) { r->front().mutable_header()->set_joint_names(1, "tail"); }},
      {"header.joint_names",
       [](Reply* r) { r->front().mutable_header()->mutable_joint_names()->RemoveLast(); }},
      {"header.frame_rate_hz: expected",
       [](Reply* r) { r->front().mutable_header()->set_frame_rate_hz(29); }},
      {"LENGTH_UNIT_MILLIMETRES",
       [](Reply* r) { r->front().mutable_header()->set_unit(v1::LENGTH_UNIT_MILLIMETRES); }},
      {"UP_AXIS_Z_UP",
       [](Reply* r) { r->front().mutable_header()->set_up_axis(v1::UP_AXIS_Z_UP); }},
      {"header.frame_count: expected the leader's 5, got 6",
       [](Reply* r) { r->front().mutable_header()->set_frame_count(6); }},
      {"chunk.first_frame: expected 0, got 2", [](Reply* r) { r->erase(r->begin() + 1); }},
      {"chunk.first_frame: expected 2, got 0",
       [](Reply* r) { r->insert(r->begin() + 1, (*r)[1]); }},
      {"chunk.frame_count: expected 1 to 5, got 0",
       [](Reply* r) { (*r)[1].mutable_chunk()->set_frame_count(0); }},
      {"chunk.frame_count: expected 1 to 5, got 4294967295",
       [](Reply* r) { (*r)[1].mutable_chunk()->set_frame_count(4294967295u); }},
      {"chunk.positions: expected 18 values",
       [](Reply* r) { (*r)[1].mutable_chunk()->mutable_positions()->RemoveLast(); }},
      {"chunk.positions[7] is not finite",
       [](Reply* r) {
         (*r)[1].mutable_chunk()->set_positions(7, std::numeric_limits<float>::quiet_NaN());
       }},
      {"chunk.positions[0] is not finite",
       [](Reply* r) {
         (*r)[2].mutable_chunk()->set_positions(0, std::numeric_limits<float>::infinity());
       }},
      {"a summary after 4 of 5 frames", [](Reply* r) { r->erase(r->begin() + 3); }},
      {"summary.frame_count: expected 5, got 4",
       [](Reply* r) { r->back().mutable_summary()->set_frame_count(4); }},
      {"summary.chunk_count: expected 3, got 2",
       [](Reply* r) { r->back().mutable_summary()->set_chunk_count(2); }},
      {"a message after the summary", [](Reply* r) { r->push_back(r->back()); }},
      {"a message without a payload", [](Reply* r) { (*r)[1].clear_payload(); }},
      {"none without reply_rotations",
       [](Reply* r) { r->front().mutable_header()->add_rig()->set_parent(-1); }},
      {"chunk.rotations: expected 0 values",
       [](Reply* r) { (*r)[1].mutable_chunk()->add_rotations(1); }},
  };
  for (const auto& [message, spoil] : breaches) {
    EXPECT_THAT(FeedSpoilt(spoil), StatusIs(absl::StatusCode::kInternal, HasSubstr(message)));
  }
}

TEST_F(ReplyAssemblerTest, TheEndOfAStreamDecidesItsStatus) {
  Reply whole = ReplyFor(leader_, 2);
  const Reply begun = {HeaderFor(leader_), ChunkFor(leader_, 0, 2)};
  const Reply unfinished(whole.begin(), whole.end() - 1);
  constexpr auto kUnavailable = absl::StatusCode::kUnavailable;
  EXPECT_THAT(Feed(unfinished), StatusIs(kUnavailable, HasSubstr("without a summary, after 5 of")));
  // A broken connection has any code, an error of the service has details.
  for (absl::StatusCode code :
       {kUnavailable, absl::StatusCode::kInternal, absl::StatusCode::kCancelled}) {
    EXPECT_THAT(Feed(begun, absl::Status(code, "RST_STREAM")),
                StatusIs(kUnavailable, HasSubstr("RST_STREAM")));
    EXPECT_THAT(Feed(begun, ServiceError(code, "says the service")),
                StatusIs(code, HasSubstr("says the service")));
  }
  EXPECT_THAT(Feed({}, absl::InternalError("no method")),
              StatusIs(absl::StatusCode::kInternal, "no method"));
  EXPECT_THAT(Feed(whole, absl::UnavailableError("closed")), IsOk());
}

TEST_F(ReplyAssemblerTest, ResumedStreamReturnsOnlyNewFrames) {
  EXPECT_THAT(Feed({HeaderFor(leader_), ChunkFor(leader_, 0, 2)}, absl::UnavailableError("")),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("after 2 of 5 frames")));
  // The second stream cuts its chunks elsewhere.
  ASSERT_THAT(Feed(ReplyFor(leader_, 3)), IsOk());
  EXPECT_THAT(handed_out_, ElementsAre(std::pair(0, 2), std::pair(2, 1), std::pair(3, 2)));
  EXPECT_EQ(frames_, FollowerFor(leader_));
  EXPECT_EQ(std::move(assembler_).TakeResult().pair.follower.poses, FollowerFor(leader_));
}

}  // namespace
}  // namespace duet::client::internal
