#include "contrib/load/live.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
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
    events_.emplace(at, LiveEvent{session, at, 0, 0, 0, EndedSession{code, 3}});
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

TEST(LiveGeneratorTest, FramesAreDueAtTheRate) {
  SimulatedLiveServer server;
  LiveOptions options = Sessions(1);
  options.frame_rate_hz = 25;
  RunLive(options, server);
  for (const auto& [time, frame] : server.frames[0]) {
    EXPECT_NEAR(ToSeconds(time - Time()), frame / 25.0, 1e-6);
  }
}

TEST(LiveGeneratorTest, SessionsAreSpreadOverTheInterval) {
  const LiveOptions options = Sessions(30);  // one session a frame, if only the opening were spread
  const auto frames = [&options](int session) {
    return ToSeconds(OpeningOf(options, session, Time()) - Time()) * 30 + 1e-5;
  };
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(std::fmod(frames(i), 1), i / 30.0, 1e-4) << i;
  EXPECT_GT(frames(29), 0.9 * 30);
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
  if (with_summary) stream->Write(response);
  return grpc::Status::OK;
}

class ServerSessionsTest : public ::testing::Test {
 protected:
  std::unique_ptr<LiveTarget> Connect() {
    client::ClientOptions options;
    options.server_address = server_.address();
    options.deadline = test::kLongestCall;
    LiveSessions sessions;
    sessions.model.joint_names = {"head", "neck"};
    sessions.model.interaction_classes = {"hug", "kick"};
    sessions.frame_rate_hz = 25;
    sessions.longest = test::kLongestCall;
    absl::StatusOr<std::unique_ptr<LiveTarget>> target = ConnectSessions(options, 1, sessions);
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

  const v1::LiveStart& start = requests.front().start();
  EXPECT_THAT(start.leader().joint_names(), ElementsAre("head", "neck"));
  EXPECT_EQ(start.leader().frame_rate_hz(), 25);
  EXPECT_EQ(start.leader().frame_count(), 0U);
  EXPECT_EQ(start.label_vector().weights(0).interaction_class(), "hug");
  EXPECT_EQ(start.seed(), 7U);
  for (std::size_t i = 1; i < requests.size(); ++i) {
    const motion::Vec3 head = SwayingJoint(answered[i - 1], 0),
                       neck = SwayingJoint(answered[i - 1], 1);
    EXPECT_THAT(requests[i].frames().positions(),
                ElementsAre(head.x, head.y, head.z, neck.x, neck.y, neck.z));
  }
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
