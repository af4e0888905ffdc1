#include "contrib/load/calls.h"

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
#include <string>
#include <utility>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "absl/synchronization/notification.h"
#include "contrib/load/server_calls.h"
#include "contrib/load/tests/context_ends.h"
#include "tests/client/support/fake_service.h"

namespace duet::contrib::load {
namespace {

using ::testing::ElementsAre;
using ::testing::Key;

TEST(TimesTest, PercentilesAreNearestRanks) {
  Times times;
  EXPECT_EQ(times.Ms(50), 0);
  EXPECT_EQ(times.MeanMs(), 0);
  for (int ms = 100; ms >= 1; --ms) times.Add(std::chrono::milliseconds(ms));
  for (const auto& [percent, ms] :
       {std::pair(0.0, 1), {1.0, 1}, {50.0, 50}, {50.5, 51}, {100.0, 100}}) {
    EXPECT_EQ(times.Ms(percent), ms) << percent;
  }
  EXPECT_DOUBLE_EQ(times.MeanMs(), 50.5);
  Times many;
  for (int i = 0; i < 999; ++i) many.Add(std::chrono::milliseconds(10));
  many.Add(std::chrono::milliseconds(50));
  EXPECT_EQ(many.Ms(99.9), 10) << "rank 999 of 1,000";
}

// A server of some workers who take calls in the order in which they come, in a time of its own
// that passes when somebody waits. Calls have 45 frames, the first of them half way.
class SimulatedServer final : public CallTarget {
 public:
  // What a test may set before it begins.
  std::size_t workers = 1;
  std::function<Duration()> cost = [] { return Seconds(0.01); };
  int max_calls = std::numeric_limits<int>::max();  // more are refused at once
  // No call begins within this time from the start.
  Duration stands_still_from{0}, stands_still_until{0};

  // What it saw.
  int most_calls = 0;

  Time Now() const override { return now_; }

  void Start(int64_t id) override {
    if (static_cast<int>(open_.size()) >= max_calls) {
      open_.emplace(now_, EndedCall{id, absl::StatusCode::kResourceExhausted, {}, now_, 0});
      return;
    }
    free_.resize(workers, Time());
    Time& worker = *std::min_element(free_.begin(), free_.end());
    Time begin = std::max(now_, worker);
    if (begin >= Time() + stands_still_from && begin < Time() + stands_still_until) {
      begin = Time() + stands_still_until;
    }
    const Duration taken = cost();
    worker = begin + taken;
    open_.emplace(worker, EndedCall{id, absl::StatusCode::kOk, begin + taken / 2, worker, 45});
    most_calls = std::max(most_calls, static_cast<int>(open_.size()));
  }

  std::vector<EndedCall> Wait(Time until) override {
    if (!open_.empty()) until = std::min(until, open_.begin()->first);
    now_ = std::max(now_, until);
    std::vector<EndedCall> ended;
    while (!open_.empty() && open_.begin()->first <= now_) {
      ended.push_back(open_.begin()->second);
      open_.erase(open_.begin());
    }
    return ended;
  }

 private:
  Time now_;
  std::vector<Time> free_;  // when each worker is
  std::multimap<Time, EndedCall> open_;
};

CallLoad Callers(int callers) { return {callers, 0}; }
CallLoad Rate(double rate_hz) { return {0, rate_hz}; }

TEST(CallsTest, CallersCallAgainAfterEachAnswer) {
  SimulatedServer server;
  server.workers = 2;
  const CallFigures seen = RunCalls(Callers(4), {}, server);
  EXPECT_EQ(server.most_calls, 4);
  EXPECT_NEAR(seen.answered_per_second(), 200, 1);
  EXPECT_NEAR(seen.frames_per_second(), 45 * 200, 45);
  EXPECT_NEAR(seen.whole_call.Ms(50), 20, 0.2);
  EXPECT_NEAR(seen.first_chunk.Ms(50), 15, 0.2);
  EXPECT_TRUE(seen.kept_up());
}

TEST(CallsTest, RateIsIndependentOfTheAnswers) {
  SimulatedServer server;
  server.cost = [] { return Seconds(0.5); };  // 2 calls a second of 50
  const CallFigures seen = RunCalls(Rate(50), {}, server);
  EXPECT_NEAR(static_cast<double>(seen.due), 500, 60);
  EXPECT_EQ(seen.sent, seen.due);
  EXPECT_EQ(seen.whole_call.count(), seen.due);
  EXPECT_NEAR(seen.answered_per_second(), 2, 0.2);
  EXPECT_TRUE(seen.kept_up());
}

TEST(CallsTest, CallsArriveAtRandom) {
  SimulatedServer server;
  server.cost = [] { return Seconds(0.008); };
  CallOptions options;
  options.measured = Seconds(100);
  const CallFigures seen = RunCalls(Rate(100), options, server);
  EXPECT_NEAR(static_cast<double>(seen.sent) / seen.seconds, 100, 3);
  // M/D/1 at 0.8: a mean wait of 16 ms. With equal gaps nobody would wait.
  EXPECT_NEAR(seen.whole_call.MeanMs(), 24, 6);
}

TEST(CallsTest, PauseOfTheServerDelaysEveryCallDueInIt) {
  for (const int max_in_flight : {4096, 1}) {  // also those that could not be sent meanwhile
    SimulatedServer server;
    server.cost = [] { return Seconds(0.001); };
    server.stands_still_from = Seconds(5);
    server.stands_still_until = Seconds(6);
    CallOptions options;
    options.max_in_flight = max_in_flight;
    const CallFigures seen = RunCalls(Rate(100), options, server);
    EXPECT_NEAR(seen.whole_call.Ms(50), 1, 0.5);
    EXPECT_NEAR(seen.whole_call.Ms(95), 550, 120);
    EXPECT_NEAR(seen.whole_call.Ms(100), 1001, 30);
    EXPECT_EQ(seen.kept_up(), max_in_flight > 1);
    EXPECT_NEAR(seen.late.Ms(95), max_in_flight > 1 ? 0 : 550, 120);
  }
}

TEST(CallsTest, CallsThatWereNeverSentAreReported) {
  SimulatedServer server;
  server.cost = [] { return Seconds(1); };
  CallOptions options;
  options.warm_up = Seconds(0);
  options.measured = Seconds(5);
  options.max_in_flight = 1;
  const CallFigures seen = RunCalls(Rate(10), options, server);
  EXPECT_NEAR(static_cast<double>(seen.due), 50, 20);
  EXPECT_EQ(seen.sent, 5);
  EXPECT_FALSE(seen.kept_up());
}

TEST(CallsTest, WarmUpIsNotMeasured) {
  SimulatedServer server;
  server.cost = [&server] {
    return server.Now() < Time() + Seconds(0.9) ? Seconds(0.05) : Seconds(0.01);
  };
  const CallFigures seen = RunCalls(Callers(1), {}, server);
  EXPECT_NEAR(seen.whole_call.Ms(100), 10, 0.1);
  EXPECT_EQ(seen.due, seen.ended.at(absl::StatusCode::kOk).count());
  EXPECT_DOUBLE_EQ(seen.seconds, 10);
}

TEST(CallsTest, RejectionsAreCountedSeparately) {
  SimulatedServer server;
  server.max_calls = 2;
  const CallFigures seen = RunCalls(Rate(300), {}, server);
  EXPECT_THAT(seen.ended,
              ElementsAre(Key(absl::StatusCode::kOk), Key(absl::StatusCode::kResourceExhausted)));
  const Times& refused = seen.ended.at(absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(refused.count() + seen.whole_call.count(), seen.due);
  EXPECT_NEAR(seen.answered_per_second(), 100, 10);
  EXPECT_LT(refused.Ms(100), 0.1);
  EXPECT_GT(seen.whole_call.Ms(0), 9.9);
}

TEST(CallsTest, StopsEarlyOnRequest) {
  for (const CallLoad& load : {Callers(2), Rate(50)}) {
    SimulatedServer server;
    CallOptions options;
    options.stopped = [&server] { return server.Now() >= Time() + Seconds(4); };
    const CallFigures seen = RunCalls(load, options, server);
    EXPECT_NEAR(seen.seconds, 3, 0.21);
    EXPECT_EQ(seen.whole_call.count(), seen.due) << "calls that were sent are waited for";
    EXPECT_GT(seen.due, 0);
  }
}

using test::FakeServer;

constexpr int kFrames = 45;

void WriteReply(int frames, bool with_summary, grpc::ServerWriter<v1::SynthesizeResponse>* writer) {
  v1::SynthesizeResponse message;
  message.mutable_header()->set_frame_count(kFrames);
  writer->Write(message);
  for (int first = 0; first < frames; first += 15) {
    message.mutable_chunk()->set_first_frame(static_cast<uint32_t>(first));
    message.mutable_chunk()->set_frame_count(15);
    writer->Write(message);
  }
  message.mutable_summary();
  if (with_summary) writer->Write(message);
}

class ServerCallsTest : public ::testing::Test {
 protected:
  std::unique_ptr<CallTarget> Connect(int connections = 1) {
    options_.server_address = server_.address();
    options_.deadline = test::kLongestCall;
    v1::SynthesizeRequest request;
    request.mutable_model()->set_name("one");
    absl::StatusOr<std::unique_ptr<CallTarget>> target =
        ConnectCalls(options_, connections, request.SerializeAsString());
    EXPECT_TRUE(target.ok()) << target.status();
    return *std::move(target);
  }

  static EndedCall Await(CallTarget& target) {
    for (;;) {
      std::vector<EndedCall> ended = target.Wait(target.Now() + std::chrono::hours(1));
      if (!ended.empty()) return ended.front();
    }
  }

  FakeServer server_;
  client::ClientOptions options_;
};

TEST_F(ServerCallsTest, SendsTheRequestAndReportsTheEnd) {
  std::string authorization, model;
  server_.service().on_synthesize = [&](auto* context, const auto& request, auto* writer) {
    const auto& metadata = context->client_metadata();
    const auto found = metadata.find("authorization");
    if (found != metadata.end()) authorization = {found->second.data(), found->second.size()};
    model = request.model().name();
    WriteReply(kFrames, true, writer);
    return grpc::Status::OK;
  };
  options_.token = "secret";
  const std::unique_ptr<CallTarget> target = Connect();
  const Time before = target->Now();
  target->Start(7);
  const EndedCall ended = Await(*target);
  EXPECT_EQ(ended.id, 7);
  EXPECT_EQ(ended.code, absl::StatusCode::kOk);
  EXPECT_EQ(ended.frames, kFrames);
  ASSERT_TRUE(ended.first_chunk.has_value());
  EXPECT_LE(before, *ended.first_chunk);
  EXPECT_LE(*ended.first_chunk, ended.end);
  EXPECT_EQ(authorization, "Bearer secret");
  EXPECT_EQ(model, "one");
}

TEST_F(ServerCallsTest, IncompleteReplyIsInternal) {
  for (const auto& [frames, with_summary] : {std::pair(30, true), std::pair(kFrames, false)}) {
    server_.service().on_synthesize = [frames = frames, with_summary = with_summary](
                                          auto*, const auto&, auto* writer) {
      WriteReply(frames, with_summary, writer);
      return grpc::Status::OK;
    };
    const std::unique_ptr<CallTarget> target = Connect();
    target->Start(1);
    EXPECT_EQ(Await(*target).code, absl::StatusCode::kInternal);
  }
}

TEST_F(ServerCallsTest, RejectionsKeepTheirCodeAndAreNotRetried) {
  std::atomic<int> calls{0};
  server_.service().on_synthesize = [&calls](auto*, const auto&, auto*) {
    ++calls;
    return grpc::Status(grpc::StatusCode::UNAVAILABLE, "later");
  };
  const std::unique_ptr<CallTarget> target = Connect();
  target->Start(1);
  const EndedCall ended = Await(*target);
  EXPECT_EQ(ended.code, absl::StatusCode::kUnavailable);
  EXPECT_FALSE(ended.first_chunk.has_value());
  EXPECT_EQ(calls, 1);
}

TEST_F(ServerCallsTest, CallsTakeConnectionsInTurn) {
  absl::Mutex mutex;
  std::set<std::string> peers;
  server_.service().on_synthesize = [&](auto* context, const auto&, auto*) {
    const absl::MutexLock lock(&mutex);
    peers.insert(context->peer());
    return grpc::Status::OK;
  };
  const std::unique_ptr<CallTarget> target = Connect(3);
  for (int i = 0; i < 6; ++i) {
    target->Start(i);
    Await(*target);
  }
  EXPECT_EQ(peers.size(), 3U);
}

// gRPC's thread that releases the last reference to a connection uses freed memory.
TEST_F(ServerCallsTest, ReleasesACallBeforeItReportsTheEnd) {
  server_.service().on_synthesize = [](auto*, const auto&, auto* writer) {
    WriteReply(kFrames, true, writer);
    return grpc::Status::OK;
  };
  absl::Notification reported, released;
  bool reported_first = false;
  const test::ContextEnds ends([&] {
    // Time for a call to be reported that is not released yet.
    reported_first = reported.WaitForNotificationWithTimeout(absl::Milliseconds(200));
    released.Notify();
  });
  const std::unique_ptr<CallTarget> target = Connect();
  target->Start(1);
  Await(*target);
  reported.Notify();
  released.WaitForNotification();
  EXPECT_FALSE(reported_first);
}

TEST(ConnectCallsTest, UnreachableServerIsAnError) {
  client::ClientOptions options;
  options.server_address = "unix:/nowhere/duet.sock";
  options.deadline = absl::Milliseconds(50);
  const absl::Status status = ConnectCalls(options, 1, "").status();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_THAT(std::string(status.message()), ::testing::HasSubstr("/nowhere/duet.sock"));
}

}  // namespace
}  // namespace duet::contrib::load
