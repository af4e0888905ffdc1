#include "contrib/load/grpc_live_target.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/synchronization/mutex.h"
#include "tests/client/support/context_ends.h"
#include "tests/client/support/fake_service.h"

namespace duet::contrib::load {
namespace {

using test::FakeServer;
using Stream = grpc::ServerReaderWriter<v1::SynthesizeLiveResponse, v1::SynthesizeLiveRequest>;

using ::testing::ElementsAre;
using ::testing::FloatEq;

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

class GrpcLiveTargetTest : public ::testing::Test {
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
        ConnectLiveTarget(options, 1, std::move(sessions));
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

TEST_F(GrpcLiveTargetTest, SendsFramesAndReportsAnswers) {
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

TEST_F(GrpcLiveTargetTest, RefusalsKeepTheirCode) {
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

TEST_F(GrpcLiveTargetTest, AStreamWithoutSummaryIsInternal) {
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
TEST_F(GrpcLiveTargetTest, ItsDestructorReleasesTheConnections) {
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

TEST_F(GrpcLiveTargetTest, OpenSessionsAreCancelled) {
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

TEST_F(GrpcLiveTargetTest, ManyFramesAreWrittenInOrder) {
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
