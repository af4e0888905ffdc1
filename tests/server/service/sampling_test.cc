// What seed, variety and candidates do on their way from the wire to the network and back.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "model/engine/clip_synthesis.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::Call;
using test::FakeDraw;
using test::FakeSynthesizer;
using test::Reply;
using test::RunningService;
using test::SampleRequest;
using test::SamplingDescription;

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

  static RunningService::Setup Serve(std::shared_ptr<FakeSynthesizer> model) {
    RunningService::Setup setup;
    setup.model = std::move(model);
    return setup;
  }

  std::shared_ptr<FakeSynthesizer> model_ =
      std::make_shared<FakeSynthesizer>(SamplingDescription());
  RunningService running_{Serve(model_)};
};

TEST_F(SamplingTest, SameSeedGivesTheSameBytesAndAnotherSeedDifferentOnes) {
  const std::vector<float> seven = Ask(7, 1).Positions();
  EXPECT_EQ(Ask(7, 1).Positions(), seven);
  EXPECT_NE(Ask(8, 1).Positions(), seven);
}

TEST_F(SamplingTest, VarietyReachesTheModel) {
  const std::vector<float> typical = Ask(7, 0).Positions();
  EXPECT_EQ(Ask(8, 0).Positions(), typical);
  EXPECT_NEAR(Ask(7, 2).Positions().front(), typical.front() + FakeDraw({7, 2}).x, 1e-5);
}

TEST_F(SamplingTest, TheDefaultSeedIsTheOneThatTheHeaderNames) {
  const Reply reply = Ask(std::nullopt, std::nullopt);
  EXPECT_EQ(reply.Positions(), Ask(reply.messages.front().header().seed(), 1).Positions());
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

TEST_F(SamplingTest, OneCandidateByDefault) {
  EXPECT_EQ(Ask(7, 1).messages.front().header().candidates(), 1u);
  EXPECT_EQ(running_.calls().WaitFor(1).candidates, 1);
}

TEST_F(SamplingTest, DeterministicModelHasOneCandidate) {
  RunningService running;
  v1::SynthesizeRequest request = Sampled(7, 1);
  request.set_candidates(4);
  const Reply reply = Call(running.stub(), request);
  ASSERT_TRUE(reply.status.ok()) << reply.status.error_message();
  EXPECT_EQ(reply.messages.front().header().candidates(), 1u);
  EXPECT_EQ(running.calls().WaitFor(1).candidates, 1);
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

TEST_F(SamplingTest, GradeNamesTheFramesThatOverlap) {
  model_->answer = [](motion::Vec3 leader, absl::Span<const float>) { return leader; };
  const v1::SynthesisSummary summary = Ask(0, 0).messages.back().summary();
  EXPECT_EQ(summary.grade().overlapping(), 1);
  EXPECT_EQ(summary.grade().skating(), summary.grade().leader_skating());
  ASSERT_EQ(summary.grade().bad_runs_size(), 1);
  EXPECT_EQ(summary.grade().bad_runs(0).first_frame(), 0u);
  EXPECT_EQ(summary.grade().bad_runs(0).frame_count(), 120u);
}

TEST_F(SamplingTest, ModelWithoutHipsHasNoGrade) {
  engine::ModelDescription description = SamplingDescription();
  description.skeleton.hips.reset();
  RunningService running(Serve(std::make_shared<FakeSynthesizer>(description)));
  const Reply reply = Call(running.stub(), Sampled(7, 1));
  ASSERT_TRUE(reply.status.ok()) << reply.status.error_message();
  EXPECT_FALSE(reply.messages.back().summary().has_grade());
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

TEST_F(SamplingTest, ModelWithoutStatisticsReportsNoUnfamiliarity) {
  EXPECT_FALSE(Ask(0, 1).messages.back().summary().has_unfamiliarity());
  EXPECT_FALSE(running_.calls().WaitFor(1).unfamiliarity.has_value());
}

}  // namespace
}  // namespace duet::server::service
