#include "contrib/load/generator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "contrib/load/tests/simulated_server.h"

namespace duet::contrib::load {
namespace {

using ::testing::ElementsAre;
using ::testing::Key;

constexpr double kMillisecond = 1e6;

Step Callers(int callers) { return {callers, 0}; }
Step Rate(double rate_hz) { return {0, rate_hz}; }

double P(const LogHistogram& histogram, double percent) {
  return static_cast<double>(histogram.Percentile(percent)) / kMillisecond;
}

LoadOptions Constant() {
  LoadOptions options;
  options.arrivals = ArrivalKind::kConstant;
  return options;
}

TEST(GeneratorTest, CallersCallAgainAfterEachAnswer) {
  SimulatedServer server;
  server.workers = 2;
  const Measurement seen = RunStep(Callers(4), {}, server);
  EXPECT_EQ(server.most_calls, 4);
  EXPECT_NEAR(seen.answered_per_second(), 200, 1);
  EXPECT_NEAR(seen.frames_per_second(), 45 * 200, 45);
  EXPECT_NEAR(P(seen.all.whole_call, 50), 20, 0.2);
  EXPECT_NEAR(P(seen.all.first_chunk, 50), 15, 0.2);
  EXPECT_NEAR(static_cast<double>(seen.all.frame_rate.Percentile(50)) / 1000, 45 / 0.02, 20);
  EXPECT_TRUE(KeptUp(seen));
}

TEST(GeneratorTest, RateIsIndependentOfTheAnswers) {
  SimulatedServer server;
  server.cost = [](std::size_t) { return Seconds(0.5); };  // 2 calls a second of 50
  const Measurement seen = RunStep(Rate(50), Constant(), server);
  EXPECT_EQ(seen.due, 500);
  EXPECT_EQ(seen.sent, 500);
  EXPECT_EQ(seen.answered(), 500);
  EXPECT_NEAR(seen.answered_per_second(), 2, 0.2);
  EXPECT_TRUE(KeptUp(seen));
}

TEST(GeneratorTest, PoissonArrivalsQueueAtRatesWhereConstantOnesDoNot) {
  SimulatedServer server, other;
  server.cost = other.cost = [](std::size_t) { return Seconds(0.008); };
  LoadOptions options;
  options.measured = Seconds(100);
  const Measurement poisson = RunStep(Rate(100), options, server);
  options.arrivals = ArrivalKind::kConstant;
  const Measurement constant = RunStep(Rate(100), options, other);
  EXPECT_NEAR(poisson.sent_per_second(), 100, 3);
  EXPECT_NEAR(P(constant.all.whole_call, 99), 8, 0.1);
  // M/D/1 at 0.8: a mean wait of 16 ms.
  EXPECT_NEAR(poisson.all.whole_call.mean() / kMillisecond, 24, 6);
}

TEST(GeneratorTest, PauseOfTheServerDelaysEveryCallDueInIt) {
  SimulatedServer server;
  server.cost = [](std::size_t) { return Seconds(0.001); };
  server.stands_still_from = Seconds(5);
  server.stands_still_until = Seconds(6);
  const Measurement seen = RunStep(Rate(100), Constant(), server);
  EXPECT_NEAR(P(seen.all.whole_call, 50), 1, 0.1);
  EXPECT_NEAR(P(seen.all.whole_call, 95), 550, 50);
  EXPECT_NEAR(P(seen.all.whole_call, 100), 1001, 1);
}

TEST(GeneratorTest, LateCallIsMeasuredFromItsDueTime) {
  SimulatedServer server;
  server.cost = [](std::size_t) { return Seconds(0.001); };
  server.stands_still_from = Seconds(5);
  server.stands_still_until = Seconds(6);
  LoadOptions options = Constant();
  options.max_in_flight = 1;
  const Measurement seen = RunStep(Rate(100), options, server);
  EXPECT_EQ(server.most_calls, 1);
  EXPECT_NEAR(P(seen.all.whole_call, 95), 550, 60);
  EXPECT_NEAR(P(seen.late, 95), 550, 60);
  EXPECT_FALSE(KeptUp(seen));
}

TEST(GeneratorTest, CallsThatWereNeverSentAreReported) {
  SimulatedServer server;
  server.cost = [](std::size_t) { return Seconds(1); };
  LoadOptions options = Constant();
  options.warm_up = Seconds(0);
  options.measured = Seconds(5);
  options.max_in_flight = 1;
  const Measurement seen = RunStep(Rate(10), options, server);
  EXPECT_EQ(seen.due, 50);
  EXPECT_EQ(seen.sent, 5);
  EXPECT_FALSE(KeptUp(seen));
}

TEST(GeneratorTest, WarmUpIsNotMeasured) {
  SimulatedServer server;
  server.cost = [&server](std::size_t) {
    return server.Now() < Time() + Seconds(0.9) ? Seconds(0.05) : Seconds(0.01);
  };
  const Measurement seen = RunStep(Callers(1), {}, server);
  EXPECT_NEAR(P(seen.all.whole_call, 100), 10, 0.1);
  EXPECT_EQ(seen.due, seen.ended.at(absl::StatusCode::kOk).count());
  EXPECT_DOUBLE_EQ(seen.seconds, 10);
}

TEST(GeneratorTest, NumberOfCallsIsExact) {
  for (const Step& step : {Callers(3), Rate(40)}) {
    SimulatedServer server;
    LoadOptions options;
    options.calls = 77;
    const Measurement seen = RunStep(step, options, server);
    EXPECT_EQ(seen.due, 77);
    EXPECT_EQ(seen.answered(), 77);
    // From the warm-up's end to the last answer.
    EXPECT_DOUBLE_EQ(seen.seconds, ToSeconds(server.Now() - Time() - options.warm_up));
  }
}

TEST(GeneratorTest, RejectionsAreCountedSeparately) {
  SimulatedServer server;
  server.max_calls = 2;
  const Measurement seen = RunStep(Rate(300), Constant(), server);
  EXPECT_THAT(seen.ended,
              ElementsAre(Key(absl::StatusCode::kOk), Key(absl::StatusCode::kResourceExhausted)));
  const LogHistogram refused = NotAnswered(seen);
  EXPECT_EQ(refused.count() + seen.answered(), 3000);
  EXPECT_NEAR(seen.answered_per_second(), 100, 2);
  EXPECT_LT(P(refused, 100), 0.1);
  EXPECT_GT(P(seen.all.whole_call, 0), 9.9);
}

TEST(GeneratorTest, KindsAreDrawnByTheirWeights) {
  LoadOptions options;
  options.kind_weights = {9, 1};
  options.calls = 10000;
  SimulatedServer server, same, other;
  for (SimulatedServer* one : {&server, &same, &other}) {
    one->cost = [](std::size_t kind) { return Seconds(kind == 0 ? 0.001 : 0.01); };
  }
  const Measurement seen = RunStep(Callers(1), options, server);
  EXPECT_NEAR(static_cast<double>(seen.by_kind[1].whole_call.count()), 1000, 100);
  EXPECT_NEAR(P(seen.by_kind[0].whole_call, 50), 1, 0.01);
  EXPECT_NEAR(P(seen.by_kind[1].whole_call, 50), 10, 0.1);
  RunStep(Callers(1), options, same);
  EXPECT_EQ(server.kinds, same.kinds);
  options.seed = 1;
  RunStep(Callers(1), options, other);
  EXPECT_NE(server.kinds, other.kinds);
}

TEST(GeneratorTest, BackgroundIsNotMeasured) {
  SimulatedServer server;
  server.workers = 3;
  server.cost = [](std::size_t kind) { return Seconds(kind == 1 ? 3 : 0.01); };
  LoadOptions options;
  options.background_callers = 2;
  options.background_kind = 1;
  const Measurement seen = RunStep(Callers(1), options, server);
  EXPECT_EQ(server.most_calls, 3);
  EXPECT_EQ(std::count(server.kinds.begin(), server.kinds.end(), 1U), 8);
  EXPECT_EQ(seen.background.at(absl::StatusCode::kOk), 6);
  EXPECT_EQ(server.cancelled, 2) << "those under way at the end";
  EXPECT_NEAR(P(seen.all.whole_call, 100), 10, 0.1);
  EXPECT_THAT(seen.ended, ElementsAre(Key(absl::StatusCode::kOk)));
}

TEST(GeneratorTest, RejectedBackgroundPausesBeforeTheNextCall) {
  SimulatedServer server;
  server.max_calls = 0;
  LoadOptions options = Constant();
  options.background_callers = 1;
  const Measurement seen = RunStep(Rate(1), options, server);
  // 11 seconds, 20 times each.
  EXPECT_NEAR(static_cast<double>(seen.background.at(absl::StatusCode::kResourceExhausted)), 220,
              12);
}

TEST(GeneratorTest, StopsEarlyOnRequest) {
  for (const Step& step : {Callers(2), Rate(50)}) {
    SimulatedServer server;
    LoadOptions options;
    options.stopped = [&server] { return server.Now() >= Time() + Seconds(4); };
    const Measurement seen = RunStep(step, options, server);
    EXPECT_NEAR(seen.seconds, 3, 0.21);
    EXPECT_EQ(seen.answered(), seen.due) << "calls that were sent are waited for";
    EXPECT_GT(seen.due, 0);
  }
}

TEST(GeneratorTest, TimelineCountsCallsByDueTime) {
  SimulatedServer server;
  server.cost = [](std::size_t) { return Seconds(0.001); };
  server.stands_still_from = Seconds(3);  // two seconds after the warm-up
  server.stands_still_until = Seconds(4);
  const Measurement seen = RunStep(Rate(100), Constant(), server);
  ASSERT_EQ(seen.timeline.size(), 10U);
  for (std::size_t i = 0; i < seen.timeline.size(); ++i) {
    EXPECT_EQ(seen.timeline[i].due, 100) << i;
    EXPECT_EQ(seen.timeline[i].answered, 100) << i;
    EXPECT_NEAR(P(seen.timeline[i].whole_call, 50), i == 2 ? 550 : 1, i == 2 ? 60 : 60) << i;
  }
  EXPECT_GT(P(seen.timeline[2].whole_call, 50), 400);
  EXPECT_LT(P(seen.timeline[5].whole_call, 99), 2);
}

TEST(GeneratorTest, KeepsARecordOfEachCall) {
  SimulatedServer server;
  std::vector<CallRecord> records;
  LoadOptions options = Constant();
  options.warm_up = Seconds(0.5);
  options.measured = Seconds(1);
  options.on_record = [&records](const CallRecord& record) { records.push_back(record); };
  const Measurement seen = RunStep(Rate(10), options, server);
  ASSERT_EQ(records.size(), 15U);
  EXPECT_EQ(records.front().due, Seconds(-0.5));
  EXPECT_EQ(records.back().due, Seconds(0.9));
  EXPECT_EQ(records.back().elapsed, Seconds(0.01));
  EXPECT_EQ(records.back().first_chunk, Seconds(0.005));
  EXPECT_EQ(records.back().frames, 45);
  EXPECT_EQ(seen.due, 10);
}

}  // namespace
}  // namespace duet::contrib::load
