// SynthesizeLive over the wire: first messages of strangers, many sessions at once, draining.

#include <gmock/gmock.h>
#include <grpcpp/support/sync_stream.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "duet/v1/live.pb.h"
#include "tests/server/support/fake_clock.h"
#include "tests/server/support/puppet_scheduler.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/server/support/timed_context.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::Decode;
using test::PuppetScheduler;
using test::RawCall;
using test::Refusal;
using test::RunningService;
using test::SampleRequest;
using test::TimedContext;

using absl::StatusCode;
using Message = v1::SynthesizeLiveRequest;

constexpr char kMethod[] = "/duet.v1.MotionSynthesis/SynthesizeLive";

RunningService::Setup LiveSetup() {
  RunningService::Setup setup;
  setup.model = std::make_shared<test::FakeSynthesizer>(test::SamplingDescription());
  return setup;
}

// A start with so many frames of history of both motions.
Message Start(int frames = 0) {
  Message message;
  *message.mutable_start() = test::SampleLiveStart(frames);
  return message;
}

Message Frames(int first, int count) {
  Message message;
  *message.mutable_frames() = test::SampleLeaderFrames(first, count);
  return message;
}

// One session.
class Session {
 public:
  explicit Session(RunningService& running) : stream_(running.stub().SynthesizeLive(&context_)) {}
  Session(RunningService& running, const Message& first) : Session(running) { Send(first); }

  void Send(const Message& message) { stream_->Write(message); }
  // The next message; without a payload at the end.
  v1::SynthesizeLiveResponse Read() {
    v1::SynthesizeLiveResponse response;
    if (!stream_->Read(&response)) response.Clear();
    return response;
  }
  // Reads to the end, and returns the status.
  grpc::Status Finish() {
    stream_->WritesDone();
    while (Read().payload_case() != v1::SynthesizeLiveResponse::PAYLOAD_NOT_SET) {
    }
    return stream_->Finish();
  }
  void Cancel() { context_.TryCancel(); }

 private:
  TimedContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<Message, v1::SynthesizeLiveResponse>> stream_;
};

Refusal RefusalOf(RunningService& running, const Message& first) {
  return Decode(Session(running, first).Finish());
}

TEST(LiveServiceTest, FirstMessageMustBeAStart) {
  RunningService running(LiveSetup());
  Message labels;
  test::AddWeight(*labels.mutable_label_change()->mutable_label_vector(), "kick", 1);
  for (const auto& [message, got] : {std::pair<Message, std::string>{Frames(0, 1), "got frames"},
                                     {labels, "got label_change"},
                                     {Message(), "got none"}}) {
    const Refusal refusal = RefusalOf(running, message);
    EXPECT_EQ(refusal.code, StatusCode::kInvalidArgument);
    EXPECT_THAT(refusal.Of("payload"), HasSubstr(got));
  }
  EXPECT_EQ(running.admission().calls(), 0u);
}

TEST(LiveServiceTest, HugeStartIsRefusedUnparsed) {
  RunningService running(LiveSetup());
  Message message = Start(3);
  // Would be refused for its length as well, but only once it was parsed.
  message.mutable_start()->mutable_history()->mutable_follower_positions()->Resize(1 << 20, 0);
  const Refusal refusal = RefusalOf(running, message);
  EXPECT_EQ(refusal.code, StatusCode::kResourceExhausted);
  EXPECT_THAT(refusal.message, HasSubstr("4194304 bytes"));
}

TEST(LiveServiceTest, BytesOfAStartAreHeldOnlyUntilTheSessionBegins) {
  RunningService::Setup setup = LiveSetup();
  const Message start = Start(60);
  setup.admission.max_held_bytes = start.ByteSizeLong() + 100;
  RunningService running(setup);
  Session first(running, start);
  EXPECT_TRUE(first.Read().has_header());
  Session second(running, start);
  EXPECT_TRUE(second.Read().has_header());
  EXPECT_EQ(running.admission().held_bytes(), 0u);
  Message longer = Start(100);
  EXPECT_EQ(RefusalOf(running, longer).code, StatusCode::kResourceExhausted);
  EXPECT_EQ(running.admission().held_bytes(), 0u);
}

TEST(LiveServiceTest, SessionsThatOpenAtOnceNeedNoRoomInTheQueue) {
  constexpr int kSessions = 12;
  PuppetScheduler scheduler;
  RunningService::Setup setup = LiveSetup();
  // A queue that is full: CheckRoom refuses, and Submit takes only windows of admitted calls.
  setup.scheduler = &scheduler;
  RunningService running(setup);
  scheduler.RefuseFirstWindows(absl::ResourceExhaustedError("the queue is full"));
  std::vector<std::unique_ptr<Session>> sessions;
  for (int i = 0; i < kSessions; ++i) {
    sessions.push_back(std::make_unique<Session>(running, Start()));
    sessions.back()->Send(Frames(0, 1));
  }
  scheduler.WaitForJobs(kSessions);
  EXPECT_EQ(test::Call(running.stub(), SampleRequest()).status.error_code(),
            grpc::StatusCode::RESOURCE_EXHAUSTED)
      << "a clip needs room";
  for (int i = 0; i < kSessions; ++i) scheduler.RunNext();
  for (const auto& session : sessions) {
    EXPECT_TRUE(session->Read().has_header());
    EXPECT_EQ(session->Read().frames().frame_count(), 1u);
    EXPECT_TRUE(session->Finish().ok());
  }
}

TEST(LiveServiceTest, SessionsAreBoundedByThePlacesOfCalls) {
  test::FakeClock clock;  // no session becomes idle
  RunningService::Setup setup = LiveSetup();
  setup.clock = &clock;
  setup.admission.max_calls = 3;
  RunningService running(setup);
  std::vector<std::unique_ptr<Session>> sessions;
  for (int i = 0; i < 3; ++i) {
    sessions.push_back(std::make_unique<Session>(running, Start()));
    EXPECT_TRUE(sessions.back()->Read().has_header());
  }
  const Refusal refusal = RefusalOf(running, Start());
  EXPECT_EQ(refusal.code, StatusCode::kResourceExhausted);
  EXPECT_GT(refusal.retry_seconds, 0);
}

TEST(LiveServiceTest, FirstWindowThatIsNotStartedInTimeCanBeRetried) {
  PuppetScheduler scheduler;
  RunningService::Setup setup = LiveSetup();
  setup.scheduler = &scheduler;
  RunningService running(setup);
  Session session(running, Start());
  session.Send(Frames(0, 1));
  scheduler.FailNext(absl::DeadlineExceededError("the deadline passed"));
  const Refusal refusal = Decode(session.Finish());
  EXPECT_EQ(refusal.code, StatusCode::kResourceExhausted);
  EXPECT_GT(refusal.retry_seconds, 0);
}

TEST(LiveServiceTest, DrainIsReportedToSessionsAtRest) {
  RunningService running(LiveSetup());
  Session never_sent(running, Start()), rests(running, Start());
  EXPECT_TRUE(never_sent.Read().has_header());
  EXPECT_TRUE(rests.Read().has_header());
  rests.Send(Frames(0, 1));
  EXPECT_TRUE(rests.Read().has_frames());
  running.admission().SetState(Admission::State::kDraining);
  running.service().AnnounceDrain();
  for (Session* session : {&never_sent, &rests}) {
    EXPECT_EQ(session->Read().notice().kind(), v1::LIVE_NOTICE_KIND_DRAINING);
    session->Send(Frames(session == &rests ? 1 : 0, 1));
    EXPECT_TRUE(session->Read().has_frames()) << "the session goes on";
    EXPECT_TRUE(session->Finish().ok());
  }
}

}  // namespace
}  // namespace duet::server::service
