// Runs from sources to sinks, over a connection to a server that mirrors the leader.
#include "client/live/live_run.h"

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/synchronization/notification.h"
#include "client/client.h"
#include "client/live/ends.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/client/support/fake_service.h"
#include "tests/client/support/fake_stub.h"
#include "tests/client/support/live_mirror.h"
#include "tests/support/status_matchers.h"

namespace duet::client::live {
namespace {

using test::FakeServer;
using test::IsOk;
using test::kLongestCall;
using test::LiveMirror;
using test::LiveServerStream;
using test::StatusIs;
using test::ThreeJointLeader;

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Yields events that a test gives, then waits for Stop or ends.
class ScriptedSource final : public LeaderSource {
 public:
  std::vector<absl::StatusOr<LeaderEvent>> events;
  bool is_live = true;
  bool waits = false;  // for Stop, instead of an end

  absl::StatusOr<LeaderFormat> Open() override {
    return LeaderFormat{{"root", "left", "right"}, 30};
  }
  absl::StatusOr<std::optional<LeaderEvent>> Next() override {
    if (next_ < events.size()) {
      absl::StatusOr<LeaderEvent>& event = events[next_++];
      if (!event.ok()) return event.status();
      return *event;
    }
    if (waits) stopped_.WaitForNotificationWithTimeout(kLongestCall);
    return std::nullopt;
  }
  void Stop() override {
    if (!is_stopped_.exchange(true)) stopped_.Notify();
  }
  bool IsLive() const override { return is_live; }
  bool is_stopped() const { return is_stopped_; }

 private:
  std::size_t next_ = 0;
  std::atomic<bool> is_stopped_{false};
  absl::Notification stopped_;
};

class KeepingSink final : public FollowerSink {
 public:
  motion::Poses poses{0, 3};
  int leaders = 0, finished = 0;
  std::string model;
  absl::Status accepts;

  absl::Status Start(const LeaderFormat& format) override {
    EXPECT_EQ(format.frame_rate_hz, 30);
    return absl::OkStatus();
  }
  absl::Status Accept(const LiveFrames& frames) override {
    EXPECT_EQ(frames.first_frame, poses.frame_count());
    poses.Append(frames.poses.all());
    return accepts;
  }
  void AcceptLeader(const LeaderFrame&) override { ++leaders; }
  absl::StatusOr<std::vector<std::string>> Finish(const LiveInfo& info) override {
    ++finished;
    model = info.model_name;
    return std::vector<std::string>{absl::StrCat("kept ", poses.frame_count())};
  }
};

class LiveRunTest : public ::testing::Test {
 protected:
  LiveRunTest() {
    server_.service().on_live = [this](grpc::ServerContext* context, LiveServerStream* stream) {
      return mirror_.Run(context, stream);
    };
    ClientOptions options;
    options.server_address = server_.address();
    options.deadline = kLongestCall;
    client_ = *Client::Create(options);
    request_.weights = {{"hug", 0}};
  }

  LeaderFrame Frame(int index) const {
    const auto pose = leader_.poses[index];
    return {index, {pose.begin(), pose.end()}, absl::Now()};
  }
  void AddFrames(int first, int end) {
    for (int frame = first; frame < end; ++frame) source_.events.push_back(Frame(frame));
  }
  absl::StatusOr<LiveReport> Run() {
    LiveRun run(&source_, {&sink_}, {});
    return run.Run(*client_, request_);
  }

  motion::Clip leader_ = ThreeJointLeader(200);
  LiveMirror mirror_;  // outlives the server
  FakeServer server_;
  absl::StatusOr<Client> client_ = absl::UnknownError("");
  LiveRequest request_;
  ScriptedSource source_;
  KeepingSink sink_;
};

TEST_F(LiveRunTest, ASourceThatIsNotLiveWaitsForEachAnswer) {
  source_.is_live = false;
  request_.delay_frames = 2;
  AddFrames(0, 50);
  std::atomic<int> most{0};
  // The leader is never more than the delay ahead of the frame that is answered.
  mirror_.before_frame = [&](int, int frame) {
    if (frame >= 0 && frame < 47) most = std::max<int>(most, mirror_.messages() - frame);
    return grpc::Status::OK;
  };
  ASSERT_THAT(Run(), IsOk());
  EXPECT_EQ(sink_.poses.frame_count(), 50);
  EXPECT_LE(most, 4);  // of the message that is being answered, and one that follows it
}

TEST_F(LiveRunTest, GapsAndLateFramesAreCounted) {
  AddFrames(0, 10);
  AddFrames(13, 15);
  AddFrames(14, 16);
  const absl::StatusOr<LiveReport> report = Run();
  ASSERT_THAT(report, IsOk());
  EXPECT_EQ(report->summary.follower_frames, 16);
  EXPECT_EQ(report->summary.gap_frames, 3);
  EXPECT_EQ(report->summary.late_frames, 1);
}

TEST_F(LiveRunTest, AFailedSessionStopsTheSource) {
  AddFrames(0, 10);
  source_.waits = true;
  mirror_.before_frame = [](int, int frame) {
    return frame == 5 ? grpc::Status(grpc::StatusCode::INVALID_ARGUMENT, "not finite")
                      : grpc::Status::OK;
  };
  EXPECT_THAT(Run(), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("not finite")));
  EXPECT_TRUE(source_.is_stopped());
  EXPECT_EQ(sink_.finished, 1);
  EXPECT_EQ(sink_.poses.frame_count(), 5);
}

TEST_F(LiveRunTest, AFailedSinkEndsTheRun) {
  AddFrames(0, 10);
  source_.waits = true;
  sink_.accepts = absl::AbortedError("standard output: cannot write all of it");
  EXPECT_THAT(Run(), StatusIs(absl::StatusCode::kAborted, HasSubstr("cannot write")));
}

TEST(LatencyLogTest, PercentilesAreOfTheLastFrames) {
  LatencyLog log;
  EXPECT_EQ(log.Percentiles().p50, absl::ZeroDuration());
  for (int i = 1; i <= 100; ++i) log.Add(absl::Milliseconds(i));
  EXPECT_EQ(log.Percentiles().p50, absl::Milliseconds(50));
  EXPECT_EQ(log.Percentiles().p99, absl::Milliseconds(99));
  for (std::size_t i = 0; i < LatencyLog::kKept; ++i) log.Add(absl::Seconds(1));
  EXPECT_EQ(log.Percentiles().p50, absl::Seconds(1));
}

TEST(ClipSourceTest, PlaysAtTheFrameRate) {
  motion::Clip clip = ThreeJointLeader(5);
  clip.frame_rate_hz = 1000;
  ClipSource source(clip, true, {"a note"});
  EXPECT_TRUE(source.IsLive());
  EXPECT_THAT(source.Notes(), ElementsAre("a note"));
  ASSERT_THAT(source.Open(), IsOk());
  const absl::Time begin = absl::Now();
  for (int frame = 0; frame < 5; ++frame) {
    const auto event = source.Next();
    ASSERT_THAT(event, IsOk());
    EXPECT_EQ(std::get<LeaderFrame>(**event).index, frame);
  }
  EXPECT_GE(absl::Now() - begin, absl::Milliseconds(4));  // never early
  EXPECT_EQ(*source.Next(), std::nullopt);
}

TEST(ClipSourceTest, StopEndsItAtOnce) {
  motion::Clip clip = ThreeJointLeader(2);
  clip.frame_rate_hz = 0.001;  // the second frame would come after a quarter of an hour
  ClipSource source(clip, true, {});
  ASSERT_TRUE(source.Next()->has_value());
  std::thread stopper([&source] { source.Stop(); });
  EXPECT_EQ(*source.Next(), std::nullopt);
  stopper.join();
}

}  // namespace
}  // namespace duet::client::live
