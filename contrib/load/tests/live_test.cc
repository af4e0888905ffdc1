#include "contrib/load/live.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "contrib/load/server_sessions.h"
#include "contrib/load/tests/context_ends.h"
#include "tests/client/support/fake_service.h"

namespace duet::contrib::load {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatEq;
using ::testing::Pair;

// A server that answers every leader frame, and those missing before it, a time after it was sent,
// in a time of its own that passes when somebody waits.
class SimulatedLiveServer final : public LiveTarget {
 public:
  // What a test may set before it begins.
  std::function<Duration(int session, int frame)> latency = [](int, int) { return Seconds(0.005); };
  int max_sessions = std::numeric_limits<int>::max();  // further ones are refused
  std::set<int> forgets, repeats;  // frames that are not sent; that are sent twice
  int breaks_at = -1;              // the first session breaks at this frame
  bool never_ends = false;         // until it is cancelled

  // What it saw.
  std::map<int, std::vector<std::pair<Time, int>>> frames;  // of each session

  Time Now() const override { return now_; }

  void Open(int session) override {
    next_[session] = 0;
    if (static_cast<int>(next_.size()) > max_sessions) {
      End(session, now_, absl::StatusCode::kResourceExhausted);
    }
  }

  void Send(int session, int frame) override {
    if (ended_.count(session) > 0) return;
    frames[session].emplace_back(now_, frame);
    const Time at = std::max(last_[session], now_ + latency(session, frame));
    last_[session] = at;
    if (session == 0 && frame == breaks_at) return End(session, at, absl::StatusCode::kUnavailable);
    for (int& next = next_[session]; next <= frame; ++next) {
      if (forgets.count(next) == 0) Answer(session, next, at);
      if (repeats.count(next) > 0) Answer(session, next, at);
    }
  }

  void Finish(int session) override {
    if (!never_ends) End(session, std::max(last_[session], now_), absl::StatusCode::kOk);
  }

  std::vector<LiveEvent> Wait(Time until) override {
    if (!events_.empty()) until = std::min(until, events_.begin()->first);
    now_ = std::max(now_, until);
    std::vector<LiveEvent> arrived;
    while (!events_.empty() && events_.begin()->first <= now_) {
      arrived.push_back(events_.begin()->second);
      events_.erase(events_.begin());
    }
    return arrived;
  }

  void CancelAll() override {
    for (const auto& [session, next] : next_) End(session, now_, absl::StatusCode::kCancelled);
  }

 private:
  void Answer(int session, int frame, Time at) {
    events_.emplace(at, LiveEvent{session, at, frame, 1, 0.002, {}});
  }
  void End(int session, Time at, absl::StatusCode code) {
    if (!ended_.insert(session).second) return;
    events_.emplace(at, LiveEvent{session, at, 0, 0, 0, EndedSession{code, 3, 2, 1}});
  }

  Time now_;
  std::map<int, int> next_;  // the next follower frame of each session
  std::map<int, Time> last_;
  std::set<int> ended_;
  std::multimap<Time, LiveEvent> events_;
};

LiveOptions Sessions(int sessions) {
  LiveOptions options;
  options.sessions = sessions;
  return options;  // 1 s of warm-up, 10 s measured, 30 frames a second
}

TEST(LiveGeneratorTest, MeasuresFromEachFrameToItsAnswer) {
  SimulatedLiveServer server;
  const LiveFigures seen = RunLive(Sessions(4), server);
  EXPECT_EQ(seen.sessions, 4);
  EXPECT_EQ(seen.sent, 4 * 300);
  EXPECT_EQ(seen.answered, 4 * 300);
  EXPECT_EQ(seen.seconds, 10);
  EXPECT_NEAR(seen.latency.Ms(50), 5, 0.1);
  EXPECT_NEAR(seen.latency.Ms(100), 5, 0.1);
  EXPECT_NEAR(seen.at_server.Ms(50), 2, 0.1);
  EXPECT_EQ(seen.first_frame.count(), 4);
  EXPECT_NEAR(seen.first_frame.Ms(100), 5, 0.1);
  EXPECT_EQ(seen.late + seen.missed + seen.lost + seen.doubled + seen.refused, 0);
  EXPECT_THAT(seen.ended, ElementsAre(Pair(absl::StatusCode::kOk, 4)));
  EXPECT_EQ(seen.skipped, 4 * 3);  // what the server's summaries say
  EXPECT_EQ(seen.interpolated, 4 * 2);
  EXPECT_EQ(seen.dropped, 4);
  EXPECT_TRUE(seen.kept_up());
}

TEST(LiveGeneratorTest, CountsLateAndMissedFrames) {
  SimulatedLiveServer server;
  // Of each second of frames one takes 40 ms and another 120; both hold up those behind them.
  server.latency = [](int, int frame) {
    return Seconds(frame % 30 == 5 ? 0.04 : frame % 30 == 15 ? 0.12 : 0.005);
  };
  const LiveFigures seen = RunLive(Sessions(1), server);
  // 40 ms: this frame alone. 120 ms: this one, and the frames 33, 67 and 100 ms later.
  EXPECT_EQ(seen.late, 10 * (1 + 3));
  EXPECT_EQ(seen.missed, 10);
  EXPECT_NEAR(seen.latency.Ms(100), 120, 1);
  EXPECT_EQ(seen.lost, 0);
}

TEST(LiveGeneratorTest, FramesLostOnTheWayAreNotSentAndNotMeasured) {
  SimulatedLiveServer server;
  LiveOptions options = Sessions(3);
  options.loss = 0.1;
  const LiveFigures seen = RunLive(options, server);
  EXPECT_NEAR(static_cast<double>(seen.sent), 3 * 300 * 0.9, 40);
  EXPECT_EQ(seen.answered, seen.sent);
  EXPECT_EQ(seen.lost + seen.doubled + seen.missed, 0);
}

TEST(LiveGeneratorTest, FindsLostAndDoubledFrames) {
  SimulatedLiveServer server;
  server.forgets = {100, 101, 200};
  server.repeats = {150, 160};
  const LiveFigures seen = RunLive(Sessions(2), server);
  EXPECT_EQ(seen.lost, 2 * 3);
  EXPECT_EQ(seen.doubled, 2 * 2);
  EXPECT_EQ(seen.answered, seen.sent - 2 * 3);
}

TEST(LiveGeneratorTest, CountsRefusedAndBrokenSessions) {
  SimulatedLiveServer server;
  server.max_sessions = 3;
  server.breaks_at = 90;
  const LiveFigures seen = RunLive(Sessions(5), server);
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
  const LiveFigures seen = RunLive(options, server);
  EXPECT_NEAR(seen.seconds, 2, 0.3);
  EXPECT_EQ(seen.answered, seen.sent);
  EXPECT_THAT(seen.ended, ElementsAre(Pair(absl::StatusCode::kOk, 1)));
}

TEST(LiveGeneratorTest, CancelsSessionsThatDoNotEnd) {
  SimulatedLiveServer server;
  server.never_ends = true;
  const LiveFigures seen = RunLive(Sessions(2), server);
  EXPECT_THAT(seen.ended, ElementsAre(Pair(absl::StatusCode::kCancelled, 2)));
}

std::vector<LiveSchedule::Frame> Frames(const LiveOptions& options, int session, int count) {
  LiveSchedule schedule(options, session, Time());
  std::vector<LiveSchedule::Frame> frames;
  for (int i = 0; i < count; ++i) frames.push_back(schedule.Next());
  return frames;
}

double SecondsOf(Time time) { return ToSeconds(time - Time()); }

TEST(LiveScheduleTest, FramesAreDueAtTheRate) {
  LiveOptions options;
  options.frame_rate_hz = 25;
  const std::vector<LiveSchedule::Frame> frames = Frames(options, 0, 100);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(frames[static_cast<size_t>(i)].index, i);
    EXPECT_NEAR(SecondsOf(frames[static_cast<size_t>(i)].due), i / 25.0, 1e-6);
    EXPECT_FALSE(frames[static_cast<size_t>(i)].lost);
  }
}

TEST(LiveScheduleTest, SessionsAreSpreadOverTheIntervalUnlessInStep) {
  LiveOptions options;
  options.frame_rate_hz = 30;
  options.sessions = 30;  // one session a frame, if only the opening were spread
  const auto phase = [&options](int session) {
    const double frames = SecondsOf(LiveSchedule(options, session, Time()).opens()) * 30 + 1e-5;
    return frames - std::floor(frames);
  };
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(phase(i), i / 30.0, 1e-4) << i;
  options.in_step = true;
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(phase(i), 0, 1e-4) << i;
  EXPECT_GT(SecondsOf(LiveSchedule(options, 29, Time()).opens()), 0.9);
}

TEST(LiveScheduleTest, JitterDelaysFramesButKeepsTheirOrder) {
  LiveOptions options;
  options.jitter = Seconds(0.08);  // more than two frames
  double most = 0;
  Time last;
  for (const LiveSchedule::Frame& frame : Frames(options, 0, 1000)) {
    const double late = SecondsOf(frame.due) - frame.index / 30.0;
    EXPECT_GE(late, -1e-6);
    EXPECT_LE(late, 0.08);
    EXPECT_GE(frame.due, last);
    last = frame.due;
    most = std::max(most, late);
  }
  EXPECT_GT(most, 0.06);
}

TEST(LiveScheduleTest, LosesAShareOfTheFramesButNeverTheFirst) {
  LiveOptions options;
  options.loss = 0.2;
  int lost = 0;
  for (int session = 0; session < 20; ++session) {
    const std::vector<LiveSchedule::Frame> frames = Frames(options, session, 100);
    EXPECT_FALSE(frames[0].lost);
    for (const LiveSchedule::Frame& frame : frames) lost += frame.lost ? 1 : 0;
  }
  EXPECT_NEAR(lost / 2000.0, 0.2, 0.03);
}

TEST(LiveScheduleTest, AStallHoldsFramesBackOnceInTheMeasuredTime) {
  LiveOptions options;
  options.warm_up = Seconds(2);
  options.measured = Seconds(5);
  options.stall = Seconds(0.5);
  const std::vector<LiveSchedule::Frame> frames = Frames(options, 0, 300);
  std::vector<double> held;
  for (const LiveSchedule::Frame& frame : frames) {
    const double late = SecondsOf(frame.due) - frame.index / 30.0;
    if (late > 1e-6) held.push_back(SecondsOf(frame.due));
  }
  EXPECT_NEAR(static_cast<double>(held.size()), 15, 1);  // half a second of frames
  EXPECT_EQ(held.front(), held.back());                  // sent at once
  EXPECT_GE(held.front(), 2.5);
  EXPECT_LE(held.front(), 7);
}

using test::FakeServer;
using Stream = grpc::ServerReaderWriter<v1::SynthesizeLiveResponse, v1::SynthesizeLiveRequest>;

// Answers each leader frame at once.
grpc::Status Mirror(Stream* stream, std::vector<v1::SynthesizeLiveRequest>* requests,
                    bool with_summary = true) {
  v1::SynthesizeLiveRequest request;
  while (stream->Read(&request)) {
    requests->push_back(request);
    v1::SynthesizeLiveResponse response;
    if (request.has_start()) {
      response.mutable_header();
    } else {
      v1::FollowerFrames* frames = response.mutable_frames();
      frames->set_first_frame(request.frames().first_frame());
      frames->set_frame_count(request.frames().frame_count());
      frames->set_server_seconds(0.25F);
    }
    stream->Write(response);
  }
  v1::SynthesizeLiveResponse response;
  response.mutable_summary()->set_skipped_frames(4);
  response.mutable_summary()->set_gap_frames(5);
  response.mutable_summary()->set_late_frames(6);
  if (with_summary) stream->Write(response);
  return grpc::Status::OK;
}

// A leader of one joint whose x is the frame.
motion::Poses Counting(int frames) {
  motion::Poses leader(frames, 1);
  for (int t = 0; t < frames; ++t) leader.at(t, 0).x = static_cast<float>(t);
  return leader;
}

class ServerSessionsTest : public ::testing::Test {
 protected:
  std::unique_ptr<LiveTarget> Connect() {
    client::ClientOptions options;
    options.server_address = server_.address();
    options.deadline = test::kLongestCall;
    LiveSessions sessions;
    sessions.content.delay_frames = 2;
    sessions.content.plan_frames = 3;
    sessions.model.joint_names = {"head"};
    sessions.model.interaction_classes = {"hug", "kick"};
    sessions.frame_rate_hz = 25;
    sessions.leaders = {Counting(3)};
    sessions.longest = test::kLongestCall;
    absl::StatusOr<std::unique_ptr<LiveTarget>> target =
        ConnectSessions(options, 1, std::move(sessions));
    EXPECT_TRUE(target.ok()) << target.status();
    return *std::move(target);
  }

  // What arrives until the session has ended.
  static std::vector<LiveEvent> AwaitEnd(LiveTarget& target) {
    std::vector<LiveEvent> all;
    while (all.empty() || !all.back().ended) {
      for (LiveEvent& event : target.Wait(target.Now() + std::chrono::hours(1))) {
        all.push_back(std::move(event));
      }
    }
    return all;
  }

  FakeServer server_;
};

TEST_F(ServerSessionsTest, SendsFramesAndReportsAnswers) {
  std::vector<v1::SynthesizeLiveRequest> requests;
  server_.service().on_live = [&](auto*, Stream* stream) { return Mirror(stream, &requests); };
  const std::unique_ptr<LiveTarget> target = Connect();
  const Time before = target->Now();
  target->Open(7);
  for (int frame = 0; frame < 6; ++frame) {
    if (frame != 2) target->Send(7, frame);
  }
  target->Finish(7);
  const std::vector<LiveEvent> events = AwaitEnd(*target);
  ASSERT_EQ(events.size(), 6U);
  std::vector<int> answered;
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(events[i].session, 7);
    EXPECT_EQ(events[i].frames, 1);
    EXPECT_EQ(events[i].server_seconds, 0.25);
    EXPECT_GE(events[i].time, before);
    answered.push_back(events[i].first_frame);
  }
  EXPECT_THAT(answered, ElementsAre(0, 1, 3, 4, 5));
  EXPECT_EQ(events[5].ended->code, absl::StatusCode::kOk);
  EXPECT_EQ(events[5].ended->skipped_frames, 4);
  EXPECT_EQ(events[5].ended->gap_frames, 5);
  EXPECT_EQ(events[5].ended->late_frames, 6);

  const v1::LiveStart& start = requests.front().start();
  EXPECT_THAT(start.leader().joint_names(), ElementsAre("head"));
  EXPECT_EQ(start.leader().frame_rate_hz(), 25);
  EXPECT_EQ(start.leader().frame_count(), 0U);
  EXPECT_EQ(start.label_vector().weights(0).interaction_class(), "hug");
  EXPECT_EQ(start.delay_frames(), 2U);
  EXPECT_EQ(start.plan_frames(), 3U);
  EXPECT_EQ(start.seed(), 7U);
  // Three frames, there and back.
  std::vector<float> sent;
  for (std::size_t i = 1; i < requests.size(); ++i) {
    sent.push_back(requests[i].frames().positions(0));
  }
  EXPECT_THAT(sent, ElementsAre(FloatEq(0), FloatEq(1), FloatEq(1), FloatEq(0), FloatEq(1)));
}

TEST_F(ServerSessionsTest, RefusalsKeepTheirCode) {
  server_.service().on_live = [](auto*, Stream*) {
    return grpc::Status(grpc::StatusCode::RESOURCE_EXHAUSTED, "full");
  };
  const std::unique_ptr<LiveTarget> target = Connect();
  target->Open(0);
  const std::vector<LiveEvent> events = AwaitEnd(*target);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].ended->code, absl::StatusCode::kResourceExhausted);
  target->Send(0, 0);  // does nothing
  target->Finish(0);
}

TEST_F(ServerSessionsTest, AStreamWithoutSummaryIsInternal) {
  std::vector<v1::SynthesizeLiveRequest> requests;
  server_.service().on_live = [&](auto*, Stream* stream) {
    return Mirror(stream, &requests, false);
  };
  const std::unique_ptr<LiveTarget> target = Connect();
  target->Open(0);
  target->Finish(0);
  EXPECT_EQ(AwaitEnd(*target).back().ended->code, absl::StatusCode::kInternal);
}

// gRPC's thread that releases the last reference to a connection uses freed memory.
TEST_F(ServerSessionsTest, ItsDestructorReleasesTheConnections) {
  std::vector<v1::SynthesizeLiveRequest> requests;
  server_.service().on_live = [&](auto*, Stream* stream) { return Mirror(stream, &requests); };
  const std::thread::id here = std::this_thread::get_id();
  std::atomic<int> released_here{0};
  const test::ContextEnds ends([&] { released_here += std::this_thread::get_id() == here; });
  constexpr int kTargets = 300;
  for (int i = 0; i < kTargets; ++i) {
    const std::unique_ptr<LiveTarget> target = Connect();
    target->Open(0);
    target->Finish(0);
    AwaitEnd(*target);
  }
  EXPECT_EQ(released_here, kTargets);
}

TEST_F(ServerSessionsTest, OpenSessionsAreCancelled) {
  std::vector<v1::SynthesizeLiveRequest> requests;
  server_.service().on_live = [&](auto*, Stream* stream) { return Mirror(stream, &requests); };
  const std::unique_ptr<LiveTarget> target = Connect();
  target->Open(0);
  target->Send(0, 0);
  while (target->Wait(target->Now() + std::chrono::hours(1)).empty()) {
  }
  target->CancelAll();
  EXPECT_EQ(AwaitEnd(*target).back().ended->code, absl::StatusCode::kCancelled);
}

TEST_F(ServerSessionsTest, ManyFramesAreWrittenInOrder) {
  std::vector<v1::SynthesizeLiveRequest> requests;
  server_.service().on_live = [&](auto*, Stream* stream) { return Mirror(stream, &requests); };
  const std::unique_ptr<LiveTarget> target = Connect();
  target->Open(0);
  for (int frame = 0; frame < 500; ++frame) target->Send(0, frame);
  target->Finish(0);
  const std::vector<LiveEvent> events = AwaitEnd(*target);
  ASSERT_EQ(events.size(), 501U);
  for (int frame = 0; frame < 500; ++frame) {
    EXPECT_EQ(events[static_cast<std::size_t>(frame)].first_frame, frame);
  }
}

}  // namespace
}  // namespace duet::contrib::load
