#include "contrib/load/live_generator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "contrib/load/tests/simulated_live_server.h"

namespace duet::contrib::load {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

constexpr double kMillisecond = 1e6;

double P(const LogHistogram& histogram, double percent) {
  return static_cast<double>(histogram.Percentile(percent)) / kMillisecond;
}

LiveOptions Sessions(int sessions) {
  LiveOptions options;
  options.sessions = sessions;
  return options;  // 1 s of warm-up, 10 s measured, 30 frames a second
}

TEST(LiveGeneratorTest, MeasuresFromEachFrameToItsAnswer) {
  SimulatedLiveServer server;
  const LiveMeasurement seen = RunLive(Sessions(4), server);
  EXPECT_EQ(seen.sessions, 4);
  EXPECT_EQ(seen.sent, 4 * 300);
  EXPECT_EQ(seen.answered, 4 * 300);
  EXPECT_EQ(seen.seconds, 10);
  EXPECT_NEAR(P(seen.latency, 50), 5, 0.1);
  EXPECT_NEAR(P(seen.latency, 100), 5, 0.1);
  EXPECT_NEAR(P(seen.at_server, 50), 2, 0.1);
  EXPECT_EQ(seen.first_frame.count(), 4);
  EXPECT_NEAR(P(seen.first_frame, 100), 5, 0.1);
  EXPECT_EQ(seen.late + seen.missed + seen.lost + seen.doubled + seen.refused, 0);
  EXPECT_THAT(seen.ended, ElementsAre(Pair(absl::StatusCode::kOk, 4)));
  EXPECT_EQ(seen.skipped, 4 * 3);  // what the server's summaries say
  EXPECT_EQ(seen.interpolated, 4 * 2);
  EXPECT_EQ(seen.dropped, 4);
  EXPECT_TRUE(KeptUp(seen));
  ASSERT_EQ(seen.timeline.size(), 10U);
  EXPECT_EQ(seen.timeline[3].sent, 120);
}

TEST(LiveGeneratorTest, CountsLateAndMissedFrames) {
  SimulatedLiveServer server;
  // Of each second of frames one takes 40 ms and another 120; both hold up those behind them.
  server.latency = [](int, int frame) {
    return Seconds(frame % 30 == 5 ? 0.04 : frame % 30 == 15 ? 0.12 : 0.005);
  };
  const LiveMeasurement seen = RunLive(Sessions(1), server);
  // 40 ms: this frame alone. 120 ms: this one, and the frames 33, 67 and 100 ms later.
  EXPECT_EQ(seen.late, 10 * (1 + 3));
  EXPECT_EQ(seen.missed, 10);
  EXPECT_NEAR(P(seen.latency, 100), 120, 1);
  EXPECT_EQ(seen.lost, 0);
}

TEST(LiveGeneratorTest, FramesLostOnTheWayAreNotSentAndNotMeasured) {
  SimulatedLiveServer server;
  LiveOptions options = Sessions(3);
  options.conditions.loss = 0.1;
  const LiveMeasurement seen = RunLive(options, server);
  EXPECT_NEAR(static_cast<double>(seen.sent), 3 * 300 * 0.9, 40);
  EXPECT_EQ(seen.answered, seen.sent);
  EXPECT_EQ(seen.lost + seen.doubled + seen.missed, 0);
}

TEST(LiveGeneratorTest, AStallDelaysNoAnswer) {
  SimulatedLiveServer server;
  LiveOptions options = Sessions(2);
  options.conditions.stall = Seconds(1);
  const LiveMeasurement seen = RunLive(options, server);
  EXPECT_NEAR(P(seen.latency, 100), 5, 0.1);  // from when the held frames were sent
  EXPECT_EQ(seen.lost + seen.doubled, 0);
}

TEST(LiveGeneratorTest, FindsLostAndDoubledFrames) {
  SimulatedLiveServer server;
  server.forgets = {100, 101, 200};
  server.repeats = {150, 160};
  const LiveMeasurement seen = RunLive(Sessions(2), server);
  EXPECT_EQ(seen.lost, 2 * 3);
  EXPECT_EQ(seen.doubled, 2 * 2);
  EXPECT_EQ(seen.answered, seen.sent - 2 * 3);
}

TEST(LiveGeneratorTest, FramesThatNeverComeAreLostAndMissed) {
  SimulatedLiveServer server;
  for (int frame = 100; frame < 1000; ++frame) server.forgets.insert(frame);
  const LiveMeasurement seen = RunLive(Sessions(1), server);
  EXPECT_GE(seen.lost, 200);
  EXPECT_EQ(seen.missed, seen.sent - seen.answered);
  EXPECT_GT(seen.missed, 0);
}

TEST(LiveGeneratorTest, CountsRefusedAndBrokenSessions) {
  SimulatedLiveServer server;
  server.max_sessions = 3;
  server.breaks_at = 90;
  const LiveMeasurement seen = RunLive(Sessions(5), server);
  EXPECT_EQ(seen.refused, 2);
  EXPECT_THAT(seen.ended, ElementsAre(Pair(absl::StatusCode::kOk, 2),
                                      Pair(absl::StatusCode::kResourceExhausted, 2),
                                      Pair(absl::StatusCode::kUnavailable, 1)));
  EXPECT_EQ(server.frames[0].back().second, 90);
  EXPECT_EQ(seen.lost, 0);  // a broken session has no answers to come
}

TEST(LiveGeneratorTest, StopsWhenAsked) {
  SimulatedLiveServer server;
  LiveOptions options = Sessions(1);
  options.stopped = [&server] { return server.Now() > Time() + Seconds(3); };
  const LiveMeasurement seen = RunLive(options, server);
  EXPECT_NEAR(seen.seconds, 2, 0.3);
  EXPECT_EQ(seen.answered, seen.sent);
  EXPECT_THAT(seen.ended, ElementsAre(Pair(absl::StatusCode::kOk, 1)));
}

TEST(LiveGeneratorTest, CancelsSessionsThatDoNotEnd) {
  SimulatedLiveServer server;
  server.never_ends = true;
  const LiveMeasurement seen = RunLive(Sessions(2), server);
  EXPECT_THAT(seen.ended, ElementsAre(Pair(absl::StatusCode::kCancelled, 2)));
}

}  // namespace
}  // namespace duet::contrib::load
