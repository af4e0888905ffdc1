// Over the wire: callers that keep to the protocol and take more than their share, or nothing.

#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>
#include <grpcpp/support/sync_stream.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "duet/v1/live.pb.h"
#include "server/service/refusals.h"
#include "tests/server/support/fakes.h"
#include "tests/server/support/puppet_scheduler.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::Call;
using test::Decode;
using test::FakeClock;
using test::Gate;
using test::PuppetScheduler;
using test::RawCall;
using test::ReadAll;
using test::Refusal;
using test::RunningService;
using test::SampleRequest;
using test::TimedContext;

using absl::StatusCode;

constexpr char kSynthesize[] = "/duet.v1.MotionSynthesis/Synthesize";

// A scheduler that holds up whoever asks it about bulk work: that is asked when a message has been
// parsed.
class HoldingScheduler final : public batching::WindowScheduler {
 public:
  absl::Status Submit(batching::WindowJob) override {
    return absl::UnavailableError("a puppet's end");
  }
  absl::Status CheckRoom(batching::Priority priority, const std::string&) const override {
    if (priority == batching::Priority::kBulk) gate.Pass();
    return absl::OkStatus();
  }
  std::size_t queued_windows() const override { return 0; }

  mutable Gate gate;
};

// A request of somewhat more than a mebibyte, of bulk work.
std::string LargeRequest() {
  v1::SynthesizeRequest request = SampleRequest();
  request.set_priority(v1::PRIORITY_BULK);
  request.mutable_leader()->mutable_positions()->Resize(300000, 0.0F);
  return request.SerializeAsString();
}

TEST(HostileClientTest, ParsingLargeRequestsDelaysNoOtherCall) {
  HoldingScheduler scheduler;
  RunningService::Setup setup;
  setup.scheduler = &scheduler;
  setup.admission.max_calls = 64;
  RunningService running(setup);
  // More than gRPC has threads, 16 at most.
  std::vector<std::unique_ptr<RawCall>> calls;
  for (int i = 0; i < 18; ++i) {
    calls.push_back(std::make_unique<RawCall>(running.channel(), kSynthesize, LargeRequest()));
  }
  scheduler.gate.WaitUntilReached();
  TimedContext context;
  v1::ListModelsResponse models;
  EXPECT_TRUE(running.stub().ListModels(&context, {}, &models).ok());
  scheduler.gate.Open();
  for (const auto& call : calls) EXPECT_FALSE(call->Finish().ok());
}

TEST(HostileClientTest, FullServerRejectsWithoutReadingTheRequest) {
  PuppetScheduler puppet;
  RunningService running(&puppet);
  puppet.Refuse(absl::ResourceExhaustedError("the queue is full"));
  RawCall call(running.channel(), kSynthesize);  // only its headers
  const Refusal refusal = Decode(call.Finish());
  EXPECT_EQ(refusal.code, StatusCode::kResourceExhausted);
  EXPECT_EQ(refusal.reason, "QUEUE_FULL");
  EXPECT_EQ(running.admission().calls(), 0u);
}

TEST(HostileClientTest, SilentCallsLeavePlacesForOtherClients) {
  RunningService::Setup setup;
  setup.admission.max_calls = 4;
  setup.admission.client_share = 0.75;
  setup.client_key = "x-client";
  RunningService running(setup);
  const auto synthesize = [&](const std::string& client) {
    TimedContext context;
    context.AddMetadata("x-client", client);
    return Call(running.stub(), SampleRequest(), context).status;
  };
  // Without the key a client is its address: this machine's.
  RawCall first(running.channel(), kSynthesize), second(running.channel(), kSynthesize),
      third(running.channel(), kSynthesize);
  while (running.admission().calls() < 3) std::this_thread::yield();
  TimedContext context;
  const Refusal refusal = Decode(Call(running.stub(), SampleRequest(), context).status);
  EXPECT_EQ(refusal.reason, "TOO_MANY_CALLS");
  EXPECT_TRUE(synthesize("somebody else").ok());
}

TEST(HostileClientTest, ShutdownEndsACallThatWaitsForItsMessage) {
  RunningService running;
  RawCall call(running.channel(), kSynthesize);  // only its headers
  while (running.calls().records().empty()) {
    running.service().AbortAll(absl::UnavailableError("the server is shutting down"));
    std::this_thread::yield();
  }
  EXPECT_EQ(Decode(call.Finish()).code, StatusCode::kUnavailable);
}

// A call whose answer is not read until told to: far more than the transport takes from a server
// whose client does not read.
class IdleReader {
 public:
  explicit IdleReader(const RunningService& running) {
    // A window that grows where it is measured would take the whole answer.
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    stub_ = v1::MotionSynthesis::NewStub(grpc::CreateCustomChannel(
        running.address(), grpc::InsecureChannelCredentials(), arguments));
    v1::SynthesizeRequest request = SampleRequest(9000);
    request.set_chunk_frames(240);
    reader_ = stub_->Synthesize(&context_, request);
  }
  ~IdleReader() { context_.TryCancel(); }

  grpc::Status ReadToTheEnd() { return ReadAll(*reader_).status; }

 private:
  grpc::ClientContext context_;
  std::unique_ptr<v1::MotionSynthesis::Stub> stub_;
  std::unique_ptr<grpc::ClientReader<v1::SynthesizeResponse>> reader_;
};

// A clock that does not run, with no other time limit than that of a stalled reader.
RunningService::Setup StandingClock(const FakeClock& clock) {
  RunningService::Setup setup;
  setup.clock = &clock;
  setup.reception.timeout_seconds = std::numeric_limits<double>::infinity();
  setup.reception.slow_seconds = std::numeric_limits<double>::infinity();
  return setup;
}

// Aborts the call of a reader that takes nothing, after its transport's window was filled.
struct EndOfADrain {
  EndOfADrain() {
    while (running.admission().calls() == 0) std::this_thread::yield();
    running.service().AbortAll(DrainingRefusal());
  }

  FakeClock clock;
  RunningService running{StandingClock(clock)};
  IdleReader reader{running};
};

TEST(HostileClientTest, EndOfADrainWaitsForNoReader) {
  EndOfADrain drain;
  drain.running.service().FinishAborted(0);
  const grpc::Status status = drain.reader.ReadToTheEnd();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(status.error_message(), "the server is shutting down");
}

TEST(HostileClientTest, SlowReaderGetsErrorDetailsAtTheEndOfADrain) {
  EndOfADrain drain;
  grpc::Status status;
  std::thread reading([&] { status = drain.reader.ReadToTheEnd(); });
  drain.running.service().FinishAborted(std::numeric_limits<int>::max());
  reading.join();
  const Refusal refusal = Decode(status);
  EXPECT_EQ(refusal.code, StatusCode::kUnavailable);
  EXPECT_EQ(refusal.reason, "SERVER_DRAINING");
  EXPECT_EQ(refusal.retry_seconds, 1);
}

TEST(HostileClientTest, RequestBytesAreSharedAndReleased) {
  RunningService::Setup setup;
  PuppetScheduler puppet;
  setup.scheduler = &puppet;
  const std::size_t bytes = SampleRequest(40).ByteSizeLong();
  setup.admission.max_held_bytes = bytes + bytes / 2;
  RunningService running(setup);
  TimedContext context;
  const auto first = running.stub().Synthesize(&context, SampleRequest(40));
  puppet.WaitForJobs(1);
  EXPECT_EQ(running.admission().held_bytes(), bytes);
  const Refusal refusal = Decode(Call(running.stub(), SampleRequest(40)).status);
  EXPECT_EQ(refusal.code, StatusCode::kResourceExhausted);
  EXPECT_EQ(refusal.reason, "TOO_MANY_BYTES");
  EXPECT_EQ(refusal.retry_seconds, 1);
  puppet.RunNext();
  EXPECT_TRUE(ReadAll(*first).status.ok());
  EXPECT_EQ(running.admission().held_bytes(), 0u);
}

// Live sessions.

using Message = v1::SynthesizeLiveRequest;

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

 private:
  TimedContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<Message, v1::SynthesizeLiveResponse>> stream_;
};

Refusal RefusalOf(RunningService& running, const Message& first) {
  return Decode(Session(running, first).Finish());
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
  scheduler.Refuse(absl::ResourceExhaustedError("the queue is full"), /*only_first_windows=*/true);
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

}  // namespace
}  // namespace duet::server::service
