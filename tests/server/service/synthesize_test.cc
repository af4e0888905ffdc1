// What Synthesize answers: order of the stream, frames, units, rates, joints.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "model/engine/clip_synthesis.h"
#include "tests/server/support/puppet_scheduler.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"

namespace duet::server::service {
namespace {

using test::AddWeight;
using test::Call;
using test::FakeAnswer;
using test::FakeDescription;
using test::FakeSynthesizer;
using test::PuppetScheduler;
using test::ReadAll;
using test::Reply;
using test::RunningService;
using test::SampleRequest;
using test::SamplingDescription;
using test::SwayingMotion;
using test::TimedContext;

// A model whose follower does what the leader does.
std::shared_ptr<FakeSynthesizer> Echo() {
  auto model = std::make_shared<FakeSynthesizer>();
  model->answer = [](motion::Vec3 leader, absl::Span<const float>) { return leader; };
  return model;
}

RunningService::Setup Serving(std::shared_ptr<FakeSynthesizer> model) {
  RunningService::Setup setup;
  setup.model = std::move(model);
  return setup;
}

float LargestDifference(const std::vector<float>& a,
                        const google::protobuf::RepeatedField<float>& b) {
  float largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(a[i] - b[static_cast<int>(i)]));
  }
  return largest;
}

TEST(SynthesizeTest, TheHeaderSaysWhoAnswersAndHow) {
  RunningService running;
  v1::SynthesizeRequest request = SampleRequest(50);
  request.mutable_leader()->set_frame_rate_hz(24);
  const Reply reply = Call(running.stub(), request);
  ASSERT_TRUE(reply.status.ok()) << reply.status.error_message();
  const v1::SynthesisHeader& header = reply.messages.front().header();
  EXPECT_EQ(header.model_name(), "fake");
  EXPECT_EQ(header.model_version(), 1u);
  EXPECT_THAT(header.joint_names(), ElementsAreArray(request.leader().joint_names()));
  EXPECT_EQ(header.frame_rate_hz(), 24);
  EXPECT_EQ(header.unit(), v1::LENGTH_UNIT_METRES);
  EXPECT_EQ(header.up_axis(), v1::UP_AXIS_Y_UP);
  EXPECT_EQ(header.frame_count(), 50u);
  EXPECT_THAT(header.interaction_classes(), ElementsAreArray(FakeDescription().classes));
  EXPECT_EQ(header.request_id(), running.calls().WaitFor(1).request_id);
}

TEST(SynthesizeTest, FirstChunkIsSentAfterTheFirstWindow) {
  PuppetScheduler puppet;
  RunningService running(&puppet);
  TimedContext context;
  const auto reader = running.stub().Synthesize(&context, SampleRequest(900));
  puppet.RunNext();
  v1::SynthesizeResponse message;
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_TRUE(message.has_header());
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_TRUE(message.has_chunk());
  EXPECT_EQ(puppet.queued_windows(), 1u) << "the second of many windows has not been evaluated";
  context.TryCancel();
  while (reader->Read(&message)) {
  }
  reader->Finish();
}

TEST(SynthesizeTest, AnswersWithTheModelsMotionInChunksWithoutGaps) {
  RunningService running;
  v1::SynthesizeRequest request = SampleRequest(200);
  request.set_chunk_frames(7);
  const Reply reply = Call(running.stub(), request);
  ASSERT_TRUE(reply.status.ok()) << reply.status.error_message();
  uint32_t next = 0;
  for (const v1::SynthesizeResponse& message : reply.messages) {
    if (!message.has_chunk()) continue;
    EXPECT_EQ(message.chunk().first_frame(), next);
    EXPECT_EQ(message.chunk().positions_size(), message.chunk().frame_count() * 15 * 3);
    next += message.chunk().frame_count();
  }
  EXPECT_EQ(next, 200u);
  EXPECT_THAT(reply.ChunkFrames(), Each(Le(7)));
  const std::vector<float> positions = reply.Positions();
  ASSERT_EQ(positions.size(), 200u * 15u * 3u);
  const motion::Poses swaying = SwayingMotion(200, 15);
  const absl::Span<const motion::Vec3> leader = swaying.all();
  const std::vector<float> labels = {1, 0, 0, 0, 0, 0};
  for (std::size_t i = 0; i < leader.size(); ++i) {
    const motion::Vec3 expected = FakeAnswer(leader[i], labels);
    const motion::Vec3 actual = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
    ASSERT_LT(Distance(actual, expected), 1e-4F) << "position " << i;
  }
}

TEST(SynthesizeTest, LabelKeyframesReachTheModel) {
  RunningService running;
  v1::SynthesizeRequest request = SampleRequest(100);
  request.clear_label_vector();
  for (const auto& [frame, weight] : {std::pair{0U, 0.0F}, std::pair{99U, 1.0F}}) {
    v1::LabelKeyframe& keyframe = *request.add_label_keyframes();
    keyframe.set_frame(frame);
    AddWeight(*keyframe.mutable_label_vector(), "push", weight);
  }
  const Reply reply = Call(running.stub(), request);
  const std::vector<float> positions = reply.Positions();
  ASSERT_EQ(positions.size(), 100u * 45u);
  // The fake lifts the follower by the sum of the weights.
  const auto lift = [&](std::size_t frame) {
    return positions[frame * 45 + 1] - request.leader().positions(static_cast<int>(frame) * 45 + 1);
  };
  EXPECT_NEAR(lift(0), 0, 1e-3);
  EXPECT_NEAR(lift(50), 50.0 / 99, 1e-3);
  EXPECT_NEAR(lift(99), 1, 1e-3);
}

TEST(SynthesizeTest, RepliesWithTheRequestedJointsInTheirOrder) {
  RunningService running(Serving(Echo()));
  v1::SynthesizeRequest request = SampleRequest(30);
  request.add_reply_joint_names("torso");
  request.add_reply_joint_names("head");
  const Reply reply = Call(running.stub(), request);
  ASSERT_TRUE(reply.status.ok()) << reply.status.error_message();
  EXPECT_THAT(reply.messages.front().header().joint_names(), ElementsAre("torso", "head"));
  const std::vector<float> positions = reply.Positions();
  ASSERT_EQ(positions.size(), 30u * 2u * 3u);
  const motion::Poses leader = SwayingMotion(30, 15);
  for (int frame = 0; frame < 30; ++frame) {
    const std::size_t first = static_cast<std::size_t>(frame) * 6;
    EXPECT_NEAR(positions[first], leader.at(frame, 2).x, 1e-4);      // torso
    EXPECT_NEAR(positions[first + 4], leader.at(frame, 0).y, 1e-4);  // head
  }
}

TEST(SynthesizeTest, ReplyHasTheLeadersUnitAxisAndOrigin) {
  const std::tuple<v1::LengthUnit, v1::UpAxis, float> cases[] = {
      {v1::LENGTH_UNIT_METRES, v1::UP_AXIS_Y_UP, 1},
      {v1::LENGTH_UNIT_METRES, v1::UP_AXIS_Z_UP, 1},
      {v1::LENGTH_UNIT_METRES, v1::UP_AXIS_Y_DOWN, 1},
      {v1::LENGTH_UNIT_MILLIMETRES, v1::UP_AXIS_Z_UP, 1000},
      {v1::LENGTH_UNIT_SBU_NORMALISED, v1::UP_AXIS_Y_DOWN, 1}};
  RunningService running(Serving(Echo()));
  for (const auto& [unit, up_axis, metre] : cases) {
    v1::SynthesizeRequest request = SampleRequest(120);
    v1::Motion& leader = *request.mutable_leader();
    leader.set_unit(unit);
    leader.set_up_axis(up_axis);
    for (float& value : *leader.mutable_positions()) value *= metre;
    const Reply reply = Call(running.stub(), request);
    ASSERT_TRUE(reply.status.ok()) << reply.status.error_message();
    EXPECT_EQ(reply.messages.front().header().unit(), unit);
    EXPECT_EQ(reply.messages.front().header().up_axis(), up_axis);
    ASSERT_EQ(reply.Positions().size(), static_cast<std::size_t>(leader.positions_size()));
    EXPECT_LT(LargestDifference(reply.Positions(), leader.positions()), 1e-4F * metre);
  }
}

TEST(SynthesizeTest, ReplyIsAtTheLeadersRate) {
  RunningService running(Serving(Echo()));
  for (const double rate : {1.0, 12.5, 15.0, 29.97, 60.0, 240.0}) {
    v1::SynthesizeRequest request = SampleRequest(40);
    v1::Motion& leader = *request.mutable_leader();
    const int frames = std::max(2, static_cast<int>(rate * 7));
    leader.set_frame_rate_hz(rate);
    leader.set_frame_count(static_cast<uint32_t>(frames));
    // A straight path: resampling there and back must not change it.
    leader.clear_positions();
    for (int frame = 0; frame < frames; ++frame) {
      for (int i = 0; i < 45; ++i) {
        leader.add_positions(static_cast<float>(0.1 * i + 0.3 * frame / rate));
      }
    }
    const Reply reply = Call(running.stub(), request);
    ASSERT_TRUE(reply.status.ok()) << reply.status.error_message();
    EXPECT_EQ(reply.messages.front().header().frame_rate_hz(), rate);
    ASSERT_EQ(reply.Positions().size(), static_cast<std::size_t>(leader.positions_size()));
    // Within what the held last frame does to the spline: a part of a model frame's way.
    EXPECT_LT(LargestDifference(reply.Positions(), leader.positions()), 0.3F / 15);
  }
}

TEST(SynthesizeTest, AnswersTenMinutesWithABoundedBuffer) {
  RunningService::Setup setup;
  setup.buffered_frames = 60;
  RunningService running(setup);
  const Reply reply = Call(running.stub(), SampleRequest(9000));
  EXPECT_TRUE(reply.status.ok()) << reply.status.error_message();
  const std::vector<int> chunks = reply.ChunkFrames();
  EXPECT_EQ(std::accumulate(chunks.begin(), chunks.end(), 0), 9000);
  // The last window of 46 frames also brings two that the spline held back before.
  EXPECT_LT(running.calls().WaitFor(1).totals.peak_buffered_frames, 60 + 46 + 2);
}

// What seed, variety, candidates and clean_up do on their way to the network and back.

// A request of several windows.
v1::SynthesizeRequest Sampled(std::optional<uint64_t> seed, std::optional<float> variety) {
  v1::SynthesizeRequest request = SampleRequest(120);
  if (seed) request.set_seed(*seed);
  if (variety) request.set_variety(*variety);
  return request;
}

class SamplingTest : public ::testing::Test {
 protected:
  Reply Ask(std::optional<uint64_t> seed, std::optional<float> variety) {
    Reply reply = Call(running_.stub(), Sampled(seed, variety));
    EXPECT_TRUE(reply.status.ok()) << reply.status.error_message();
    return reply;
  }

  std::shared_ptr<FakeSynthesizer> model_ =
      std::make_shared<FakeSynthesizer>(SamplingDescription());
  RunningService running_{Serving(model_)};
};

TEST_F(SamplingTest, SameSeedGivesTheSameBytesAndAnotherSeedDifferentOnes) {
  const std::vector<float> seven = Ask(7, 1).Positions();
  EXPECT_EQ(Ask(7, 1).Positions(), seven);
  EXPECT_NE(Ask(8, 1).Positions(), seven);
}

TEST_F(SamplingTest, TheHeaderAndTheLogSayWhatWasUsed) {
  const Reply given = Ask(18446744073709551615u, 0.25f);
  EXPECT_EQ(given.messages.front().header().seed(), 18446744073709551615u);
  EXPECT_EQ(given.messages.front().header().variety(), 0.25f);
  const metrics::CallRecord record = running_.calls().WaitFor(1);
  EXPECT_EQ(record.seed, 18446744073709551615u);
  EXPECT_EQ(record.variety, 0.25f);
  const Reply absent = Ask(std::nullopt, std::nullopt);
  EXPECT_GT(absent.messages.front().header().seed(), 0u);
  EXPECT_EQ(absent.messages.front().header().variety(), 1);
}

TEST_F(SamplingTest, CandidatesReachEveryWindow) {
  std::vector<int> candidates;
  model_->on_batch = [&](absl::Span<const engine::SynthesisWindow* const> windows) {
    for (const engine::SynthesisWindow* window : windows) {
      candidates.push_back(window->options.sampling.candidates);
    }
  };
  v1::SynthesizeRequest request = Sampled(7, 1);
  request.set_candidates(4);
  const Reply reply = Call(running_.stub(), request);
  ASSERT_TRUE(reply.status.ok()) << reply.status.error_message();
  EXPECT_THAT(candidates, AllOf(SizeIs(Ge(2u)), Each(4)));
  EXPECT_EQ(reply.messages.front().header().candidates(), 4u);
  EXPECT_EQ(running_.calls().WaitFor(1).candidates, 4);
}

TEST_F(SamplingTest, SummaryGradesTheFollower) {
  const v1::SynthesisSummary summary = Ask(0, 1).messages.back().summary();
  ASSERT_TRUE(summary.has_grade());
  for (const float share : {summary.grade().twisted(), summary.grade().skating(),
                            summary.grade().leader_skating(), summary.grade().overlapping()}) {
    EXPECT_THAT(share, AllOf(Ge(0), Le(1)));
  }
  EXPECT_EQ(summary.grade().overlapping(), 0);
  EXPECT_EQ(summary.grade().bad_runs_size(), 0);
}

TEST_F(SamplingTest, DeterministicModelIgnoresSeedAndVarietyAndEchoesThem) {
  RunningService running;
  const Reply plain = Call(running.stub(), Sampled(std::nullopt, std::nullopt));
  const Reply seeded = Call(running.stub(), Sampled(7, 2));
  ASSERT_TRUE(seeded.status.ok()) << seeded.status.error_message();
  EXPECT_EQ(seeded.Positions(), plain.Positions());
  EXPECT_EQ(seeded.messages.front().header().seed(), 7u);
  EXPECT_EQ(seeded.messages.front().header().variety(), 2);
}

TEST_F(SamplingTest, SummaryAndLogReportUnfamiliarity) {
  model_->unfamiliarity = [](const engine::ClipRequest& request) {
    return request.leader.frame_count() / 100.0;
  };
  const v1::SynthesisSummary summary = Ask(0, 1).messages.back().summary();
  ASSERT_TRUE(summary.has_unfamiliarity());
  EXPECT_EQ(summary.unfamiliarity(), 1.2);
  EXPECT_EQ(running_.calls().WaitFor(1).unfamiliarity, 1.2);
}

TEST(CleanUpTest, TheRequestWinsOverTheOperatorAndTheOperatorOverTheModel) {
  const struct {
    bool samples;
    std::optional<bool> operators_choice;
    v1::CleanUp wanted, used;
  } cases[] = {{true, std::nullopt, v1::CLEAN_UP_UNSPECIFIED, v1::CLEAN_UP_ON},
               {false, std::nullopt, v1::CLEAN_UP_UNSPECIFIED, v1::CLEAN_UP_OFF},
               {true, false, v1::CLEAN_UP_UNSPECIFIED, v1::CLEAN_UP_OFF},
               {false, true, v1::CLEAN_UP_UNSPECIFIED, v1::CLEAN_UP_ON},
               {true, false, v1::CLEAN_UP_ON, v1::CLEAN_UP_ON},
               {false, true, v1::CLEAN_UP_OFF, v1::CLEAN_UP_OFF}};
  for (const auto& one : cases) {
    const auto model =
        std::make_shared<FakeSynthesizer>(one.samples ? SamplingDescription() : FakeDescription());
    std::vector<std::optional<bool>> told;  // one window at a time is evaluated
    model->on_batch = [&](absl::Span<const engine::SynthesisWindow* const> windows) {
      told.push_back(windows[0]->options.clean_up);
    };
    RunningService::Setup setup = Serving(model);
    setup.clean_up = one.operators_choice;
    RunningService running(setup);
    v1::SynthesizeRequest request = SampleRequest(120);  // several windows
    request.set_clean_up(one.wanted);
    const Reply reply = Call(running.stub(), request);
    ASSERT_TRUE(reply.status.ok()) << reply.status.error_message();
    EXPECT_EQ(reply.messages.front().header().clean_up(), one.used);
    EXPECT_THAT(told, AllOf(SizeIs(Ge(2u)), Each(one.used == v1::CLEAN_UP_ON)));
  }
}

}  // namespace
}  // namespace duet::server::service
