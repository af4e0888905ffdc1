// Callers that keep to the protocol and mean no good, or no longer care: over the wire.

#include <gmock/gmock.h>
#include <grpcpp/completion_queue.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>
#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/service/refusals.h"
#include "tests/server/support/fake_clock.h"
#include "tests/server/support/puppet_scheduler.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/refusal.h"
#include "tests/server/support/running_service.h"
#include "tests/server/support/sample_request.h"
#include "tests/server/support/timed_context.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::Call;
using test::Decode;
using test::FakeClock;
using test::LimitCall;
using test::PuppetScheduler;
using test::RawCall;
using test::ReadAll;
using test::Refusal;
using test::RunningService;
using test::SampleRequest;
using test::TimedContext;

using absl::StatusCode;

// A call that sends its headers and then nothing, until told to.
class SilentCall {
 public:
  explicit SilentCall(const RunningService& running,
                      const std::string& method = "/duet.v1.MotionSynthesis/Synthesize")
      : stub_(running.channel()) {
    LimitCall(context_);
    call_ = stub_.PrepareCall(&context_, method, &queue_);
    call_->StartCall(nullptr);
    Next();
  }
  ~SilentCall() {
    context_.TryCancel();
    queue_.Shutdown();
    while (Next()) {
    }
  }
  void SendNoMore() {
    call_->WritesDone(nullptr);
    Next();
  }
  void Cancel() { context_.TryCancel(); }
  grpc::Status Finish() {
    grpc::Status status;
    call_->Finish(&status, nullptr);
    Next();
    return status;
  }

 private:
  bool Next() {
    void* tag = nullptr;
    bool ok = false;
    return queue_.Next(&tag, &ok) && ok;
  }

  grpc::GenericStub stub_;
  grpc::ClientContext context_;
  grpc::CompletionQueue queue_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
};

// A scheduler that keeps whoever asks it about bulk work waiting: that is asked when a message has
// been parsed.
class StandingScheduler final : public batching::WindowScheduler {
 public:
  absl::Status Submit(batching::WindowJob) override {
    return absl::UnavailableError("a puppet's end");
  }
  absl::Status CheckRoom(batching::Priority priority, const std::string&) const override {
    common::MutexLock lock(mutex_);
    if (priority == batching::Priority::kBulk) ++waiting_;
    changed_.NotifyAll();
    while (priority == batching::Priority::kBulk && !may_go_on_) changed_.Wait(mutex_);
    return absl::OkStatus();
  }
  std::size_t queued_windows() const override { return 0; }

  void WaitForOne() const {
    common::MutexLock lock(mutex_);
    while (waiting_ == 0) changed_.Wait(mutex_);
  }
  void GoOn() {
    common::MutexLock lock(mutex_);
    may_go_on_ = true;
    changed_.NotifyAll();
  }

 private:
  mutable common::Mutex mutex_;
  mutable common::CondVar changed_;
  mutable int waiting_ DUET_GUARDED_BY(mutex_) = 0;
  bool may_go_on_ DUET_GUARDED_BY(mutex_) = false;
};

// A request of somewhat more than a mebibyte, of bulk work.
std::string LargeRequest() {
  v1::SynthesizeRequest request = SampleRequest();
  request.set_priority(v1::PRIORITY_BULK);
  request.mutable_leader()->mutable_positions()->Resize(300000, 0.0F);
  return request.SerializeAsString();
}

TEST(HostileClientTest, ParsingLargeRequestsDelaysNoOtherCall) {
  StandingScheduler scheduler;
  RunningService::Setup setup;
  setup.scheduler = &scheduler;
  setup.admission.max_calls = 64;
  RunningService running(setup);
  // More than gRPC has threads, 16 at most.
  std::vector<std::unique_ptr<RawCall>> calls;
  for (int i = 0; i < 18; ++i) {
    calls.push_back(std::make_unique<RawCall>(
        running.channel(), "/duet.v1.MotionSynthesis/Synthesize", LargeRequest()));
  }
  scheduler.WaitForOne();
  TimedContext context;
  v1::ListModelsResponse models;
  EXPECT_TRUE(running.stub().ListModels(&context, {}, &models).ok());
  scheduler.GoOn();
  for (const auto& call : calls) EXPECT_FALSE(call->Finish().ok());
}

TEST(HostileClientTest, EveryMethodBoundsWhatItDoesNotKnow) {
  RunningService running;
  std::string bomb;
  for (int i = 0; i < 2000; ++i) bomb.append("\xf8\x06\x01", 3);
  for (const char* method : {"Synthesize", "ListModels", "GetModel"}) {
    RawCall call(running.channel(), std::string("/duet.v1.MotionSynthesis/") + method, bomb);
    EXPECT_FALSE(call.Read().has_value()) << method;
    EXPECT_EQ(Decode(call.Finish()).code, StatusCode::kInvalidArgument) << method;
  }
}

TEST(HostileClientTest, FullServerRejectsWithoutReadingTheRequest) {
  PuppetScheduler puppet;
  RunningService running(&puppet);
  puppet.Refuse(absl::ResourceExhaustedError("the queue is full"));
  SilentCall call(running);
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
  SilentCall first(running), second(running), third(running);
  while (running.admission().calls() < 3) std::this_thread::yield();
  TimedContext context;
  const Refusal refusal = Decode(Call(running.stub(), SampleRequest(), context).status);
  EXPECT_EQ(refusal.reason, "TOO_MANY_CALLS");
  EXPECT_TRUE(synthesize("somebody else").ok());
}

TEST(HostileClientTest, CallWithoutAMessageIsMalformed) {
  RunningService running;
  for (const char* method : {"Synthesize", "GetModel"}) {
    SilentCall call(running, std::string("/duet.v1.MotionSynthesis/") + method);
    call.SendNoMore();
    EXPECT_EQ(Decode(call.Finish()).code, StatusCode::kInvalidArgument) << method;
  }
}

TEST(HostileClientTest, ShutdownEndsACallThatWaitsForItsMessage) {
  RunningService running;
  SilentCall call(running);
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

TEST(HostileClientTest, WindowsCarryTheNameOfTheirClient) {
  PuppetScheduler puppet;
  RunningService::Setup setup;
  setup.scheduler = &puppet;
  setup.client_key = "x-client";
  RunningService running(setup);
  TimedContext context;
  context.AddMetadata("x-client", "studio");
  const auto reader = running.stub().Synthesize(&context, SampleRequest());
  puppet.WaitForJobs(1);
  EXPECT_EQ(puppet.NextClient(), "studio");
  puppet.RunNext();
  EXPECT_TRUE(ReadAll(*reader).status.ok());
}

}  // namespace
}  // namespace duet::server::service
