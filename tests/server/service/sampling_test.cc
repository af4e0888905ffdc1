// What seed, variety and candidates do on their way from the wire to the network and back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "model/engine/clip_synthesis.h"
#include "server/common/mutex.h"
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

using test::FakeDescription;

// A service whose model notes what each of its windows was told.
class Service {
 public:
  Service(engine::ModelDescription model, std::optional<bool> operators_choice) {
    auto noting = std::make_shared<FakeSynthesizer>(std::move(model));
    noting->on_batch = [this](absl::Span<const engine::SynthesisWindow* const> windows) {
      common::MutexLock lock(mutex_);
      for (const engine::SynthesisWindow* window : windows)
        told_.push_back(window->options.clean_up);
    };
    RunningService::Setup setup;
    setup.model = std::move(noting);
    setup.clean_up = operators_choice;
    running_ = std::make_unique<RunningService>(setup);
  }

  // Makes a call of several windows. What the header says, where every window was told the same.
  std::optional<v1::CleanUp> Ask(v1::CleanUp wanted) {
    v1::SynthesizeRequest request = SampleRequest(120);
    request.set_clean_up(wanted);
    const Reply reply = Call(running_->stub(), request);
    EXPECT_TRUE(reply.status.ok()) << reply.status.error_message();
    if (!reply.status.ok()) return std::nullopt;
    const v1::CleanUp said = reply.messages.front().header().clean_up();
    common::MutexLock lock(mutex_);
    EXPECT_GT(told_.size(), 1u);
    for (const std::optional<bool>& told : told_) EXPECT_EQ(told, said == v1::CLEAN_UP_ON);
    told_.clear();
    return said;
  }

  RunningService& running() { return *running_; }

 private:
  common::Mutex mutex_;
  std::vector<std::optional<bool>> told_ DUET_GUARDED_BY(mutex_);
  std::unique_ptr<RunningService> running_;
};

TEST(CleanUpChoiceTest, DefaultDependsOnWhetherTheModelSamples) {
  EXPECT_EQ(Service(SamplingDescription(), std::nullopt).Ask(v1::CLEAN_UP_UNSPECIFIED),
            v1::CLEAN_UP_ON);
  EXPECT_EQ(Service(FakeDescription(), std::nullopt).Ask(v1::CLEAN_UP_UNSPECIFIED),
            v1::CLEAN_UP_OFF);
}

TEST(CleanUpChoiceTest, TheOperatorWinsOverTheModel) {
  EXPECT_EQ(Service(SamplingDescription(), false).Ask(v1::CLEAN_UP_UNSPECIFIED), v1::CLEAN_UP_OFF);
  EXPECT_EQ(Service(FakeDescription(), true).Ask(v1::CLEAN_UP_UNSPECIFIED), v1::CLEAN_UP_ON);
}

TEST(CleanUpChoiceTest, TheRequestWinsOverBoth) {
  Service never(SamplingDescription(), false);
  EXPECT_EQ(never.Ask(v1::CLEAN_UP_ON), v1::CLEAN_UP_ON);
  EXPECT_EQ(never.Ask(v1::CLEAN_UP_OFF), v1::CLEAN_UP_OFF) << "the call before has no say";
  Service always(FakeDescription(), true);
  EXPECT_EQ(always.Ask(v1::CLEAN_UP_OFF), v1::CLEAN_UP_OFF);
}

}  // namespace
}  // namespace duet::server::service
