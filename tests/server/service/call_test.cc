// Call with a source that the test controls. live_replies_test.cc and the tests over the wire test
// the sources of SynthesizeLive and Synthesize.
#include "server/service/call.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "duet/v1/model.pb.h"
#include "model/base/request_id.h"
#include "server/service/call_pipeline.h"
#include "server/service/refusals.h"
#include "server/service/wire.h"
#include "tests/server/support/fakes.h"
#include "tests/server/support/refusal.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::FakeClock;
using test::RecordingObserver;
using ::testing::_;

using absl::StatusCode;
using std::chrono::milliseconds;
using std::chrono::seconds;

// A caller that the test steps. Any message can be a reply: here a ModelSelector with a name.
class PuppetTransport final : public Transport {
 public:
  void Read() override { ++reads; }
  void Write(const google::protobuf::Message& reply) override {
    EXPECT_FALSE(writing) << "two writes at once";
    EXPECT_FALSE(finished.has_value()) << "a write after the end";
    writing = true;
    replies.push_back(dynamic_cast<const v1::ModelSelector&>(reply));
  }
  void Finish(CallScope& scope, const absl::Status& status) override {
    EXPECT_FALSE(writing) << "the end during a write";
    EXPECT_FALSE(finished.has_value()) << "two ends";
    scope.Finish(status);
    finished = status;
  }
  void BreakOff(const absl::Status& reason) override {
    ++broken_off;
    broken_off_with = reason;
    if (on_break_off) on_break_off();
  }

  // The reader took the message that is being written.
  void Written(Call& call, bool ok = true) {
    ASSERT_TRUE(writing);
    writing = false;
    call.OnWritten(ok);
  }

  int reads = 0;
  bool writing = false;
  int broken_off = 0;
  absl::Status broken_off_with;
  std::function<void()> on_break_off;
  std::vector<v1::ModelSelector> replies;
  std::optional<absl::Status> finished;
};

// What the test sees of a source that the call owns.
struct SourceState {
  absl::Status start;
  std::deque<std::string> ready;  // names of the next replies
  std::optional<absl::Status> end;
  std::function<void()> on_next;  // called while a reply is asked for
  SourceEvents events;
  bool cancelled = false;
  int reports = 0;
  std::vector<absl::StatusOr<v1::SynthesizeLiveRequest>> messages;
  int ends = 0, drains = 0;
};

class PuppetSource final : public ReplySource {
 public:
  explicit PuppetSource(SourceState& state) : state_(state) {}

  absl::Status Start(SourceEvents events) override {
    state_.events = std::move(events);
    return state_.start;
  }
  NextReply Next(metrics::CallRecord&) override {
    if (state_.on_next) std::exchange(state_.on_next, nullptr)();
    if (state_.ready.empty()) return {nullptr, state_.end};
    reply_.set_name(state_.ready.front());
    state_.ready.pop_front();
    return {&reply_, {}};
  }
  void Cancel() override { state_.cancelled = true; }
  void Report(metrics::CallRecord& record) const override {
    ++state_.reports;
    record.model = "puppet";
  }
  void OnMessage(const absl::StatusOr<v1::SynthesizeLiveRequest>& message) override {
    state_.messages.push_back(message);
  }
  void OnEndOfMessages() override { ++state_.ends; }
  void OnDraining() override { ++state_.drains; }

 private:
  SourceState& state_;
  v1::ModelSelector reply_;
};

grpc::ByteBuffer Bytes(uint32_t first_frame) {
  v1::SynthesizeLiveRequest message;
  message.mutable_frames()->set_first_frame(first_frame);
  return SerializeMessage(message);
}

class CallTest : public ::testing::Test {
 protected:
  CallTest() : admission_(Limits()) { admission_.SetState(Admission::State::kServing); }

  static AdmissionLimits Limits() {
    AdmissionLimits limits;
    limits.max_calls = 4;
    limits.max_slow_requests = 1;
    return limits;
  }

  // A call that waits for its first message.
  std::shared_ptr<Call> Receive(PuppetTransport& transport) {
    Call::Parts parts;
    parts.transport = &transport;
    parts.admission = &admission_;
    parts.clock = &clock_;
    parts.limits = {0.1, 30};
    parts.scope = std::make_unique<CallScope>(
        metrics::MethodInfo{"service", "Method", "bidi_stream"}, observers_, clock_);
    parts.client = "client";
    parts.place = *admission_.Admit("client");
    return Call::Create(std::move(parts));
  }

  // Lets a call that handles its first message stream.
  void Run(Call& call, bool takes_messages = false) {
    Call::Stream stream;
    stream.source = std::make_unique<PuppetSource>(source_);
    stream.deadline = clock_.Now() + seconds(3600);
    stream.write_timeout_seconds = 30;
    stream.takes_messages = takes_messages;
    call.Run(std::move(stream));
  }

  FakeClock clock_;
  RecordingObserver observer_;
  std::vector<metrics::CallObserver*> observers_ = {&observer_};
  Admission admission_;
  SourceState source_;
  PuppetTransport transport_;
};

TEST_F(CallTest, EventsAfterTheEndAreIgnored) {
  const auto call = Receive(transport_);
  call->Abort(DrainingRefusal());
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kUnavailable, _));
  EXPECT_FALSE(call->OnFirstMessage());
  call->OnNoMessage(/*cancelled=*/true);
  call->Abort(absl::CancelledError("late"));
  call->CheckTime(clock_.Now() + std::chrono::hours(1));
  EXPECT_EQ(observer_.records().size(), 1u);
}

TEST_F(CallTest, AbortWaitsForTheMessageBeingHandled) {
  const auto call = Receive(transport_);
  EXPECT_TRUE(call->OnFirstMessage());
  EXPECT_FALSE(call->ended_meanwhile().has_value());
  call->Abort(absl::CancelledError("gone"));
  EXPECT_THAT(call->ended_meanwhile().value_or(absl::OkStatus()),
              StatusIs(StatusCode::kCancelled, _));
  call->CheckTime(clock_.Now() + std::chrono::hours(1));
  EXPECT_FALSE(transport_.finished.has_value());
  call->Refuse(DrainingRefusal());
  EXPECT_TRUE(transport_.finished.has_value());
}

TEST_F(CallTest, CallThatEndedWhileItWasHandledWritesNothing) {
  source_.ready = {"never"};
  const auto call = Receive(transport_);
  EXPECT_TRUE(call->OnFirstMessage());
  call->Abort(absl::CancelledError("gone"));
  Run(*call);
  EXPECT_TRUE(source_.cancelled);
  EXPECT_THAT(transport_.replies, IsEmpty());
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kCancelled, "gone"));
}

TEST_F(CallTest, SlowMessageNeedsAdmissionUntilItArrivesOrItsCallEnds) {
  PuppetTransport second_transport;
  const auto first = Receive(transport_), second = Receive(second_transport);
  clock_.Advance(milliseconds(99));
  first->CheckTime(clock_.Now());
  second->CheckTime(clock_.Now());
  EXPECT_FALSE(second_transport.finished.has_value());
  clock_.Advance(milliseconds(1));
  first->CheckTime(clock_.Now());
  first->CheckTime(clock_.Now());  // has leave already
  EXPECT_FALSE(transport_.finished.has_value());
  second->CheckTime(clock_.Now());
  ASSERT_TRUE(second_transport.finished.has_value());
  EXPECT_EQ(second_transport.finished->code(), StatusCode::kResourceExhausted);
  EXPECT_EQ(test::Decode(*second_transport.finished).retry_seconds, 1);
  PuppetTransport third_transport, fourth_transport;
  ASSERT_TRUE(first->OnFirstMessage());
  const auto third = Receive(third_transport);
  clock_.Advance(milliseconds(100));
  third->CheckTime(clock_.Now());
  EXPECT_FALSE(third_transport.finished.has_value()) << "the leave of the first is free";
  third->Abort(absl::CancelledError("gone"));
  const auto fourth = Receive(fourth_transport);
  clock_.Advance(milliseconds(100));
  fourth->CheckTime(clock_.Now());
  EXPECT_FALSE(fourth_transport.finished.has_value());
}

TEST_F(CallTest, MessageAfterTheTimeoutEndsTheCall) {
  const auto call = Receive(transport_);
  clock_.Advance(milliseconds(29999));
  call->CheckTime(clock_.Now());
  EXPECT_FALSE(transport_.finished.has_value());
  clock_.Advance(milliseconds(1));
  call->CheckTime(clock_.Now());
  EXPECT_THAT(*transport_.finished,
              StatusIs(StatusCode::kDeadlineExceeded, HasSubstr("receive_timeout_seconds = 30")));
  EXPECT_EQ(admission_.calls(), 0u);
}

TEST_F(CallTest, ActiveCallsTellLaterCallsOfDrainAndEnd) {
  ActiveCalls calls;
  const auto before = Receive(transport_);
  calls.Add(before);
  calls.Drain();
  EXPECT_TRUE(before->OnFirstMessage());
  Run(*before, /*takes_messages=*/true);
  EXPECT_EQ(source_.drains, 1);
  calls.AbortAll(absl::UnavailableError("over"));
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kUnavailable, "over"));
  PuppetTransport later;
  calls.Add(Receive(later));
  EXPECT_THAT(*later.finished, StatusIs(StatusCode::kUnavailable, "over"))
      << "it was admitted before the end";
}

TEST(AdmissionTest, AdmitsUpToItsLimitReservesAQuarterAndAdmitsNobodyWhileItDrains) {
  AdmissionLimits limits;
  limits.max_calls = 4;
  Admission admission(limits);
  admission.SetState(Admission::State::kServing);
  std::vector<ShareLease> places;
  for (int i = 0; i < 4; ++i) {
    EXPECT_THAT(admission.CheckShare(batching::Priority::kBulk), IsOk()) << i;
    places.push_back(*admission.Admit("a"));
  }
  EXPECT_THAT(admission.Admit("a"), StatusIs(StatusCode::kResourceExhausted, _));
  EXPECT_THAT(admission.CheckShare(batching::Priority::kInteractive), IsOk());
  EXPECT_THAT(admission.CheckShare(batching::Priority::kBulk),
              StatusIs(StatusCode::kResourceExhausted, HasSubstr("at most 3 of this priority")));
  places.pop_back();
  EXPECT_THAT(admission.Admit("a"), IsOk());
  admission.SetState(Admission::State::kDraining);
  EXPECT_THAT(admission.Admit("a"), StatusIs(StatusCode::kUnavailable, _));
  EXPECT_EQ(admission.calls(), 3u) << "who is in stays";
}

// A call that streams.
class StreamTest : public CallTest {
 protected:
  void SetUp() override {
    call_ = Receive(transport_);
    ASSERT_TRUE(call_->OnFirstMessage());
  }
  void Run() { CallTest::Run(*call_); }
  void Written(bool ok = true) { transport_.Written(*call_, ok); }
  void Progress(std::string reply) {
    source_.ready.push_back(std::move(reply));
    source_.events.on_progress();
  }
  std::vector<std::string> written() const {
    std::vector<std::string> names;
    for (const v1::ModelSelector& reply : transport_.replies) names.push_back(reply.name());
    return names;
  }

  std::shared_ptr<Call> call_;
};

TEST_F(StreamTest, WritesEachReplyOnceItIsReady) {
  Run();
  EXPECT_THAT(written(), IsEmpty());
  Progress("one");
  EXPECT_THAT(written(), ElementsAre("one"));
  Progress("two");
  EXPECT_THAT(written(), ElementsAre("one")) << "the first write is not over";
  Written();
  EXPECT_THAT(written(), ElementsAre("one", "two"));
  Written();
  EXPECT_FALSE(transport_.finished.has_value()) << "the source has not ended";
}

TEST_F(StreamTest, ProgressWhileTheSourceIsAskedIsNotLost) {
  Run();
  source_.on_next = [this] {
    // Another thread makes a reply just after the source has found none.
    source_.on_next = [this] { source_.ready.push_back("one"); };
    source_.events.on_progress();
  };
  source_.events.on_progress();
  EXPECT_THAT(written(), ElementsAre("one"));
}

TEST_F(StreamTest, EndsWithTheStatusOfItsSource) {
  source_.ready = {"last"};
  source_.end = absl::OkStatus();
  Run();
  Written();
  EXPECT_THAT(*transport_.finished, IsOk());
  EXPECT_EQ(source_.reports, 1);
  EXPECT_EQ(observer_.WaitFor(1).model, "puppet");
}

TEST_F(StreamTest, SourceThatDoesNotStartEndsTheCallBeforeAnyReply) {
  source_.start = absl::ResourceExhaustedError("full");
  source_.ready = {"never"};
  Run();
  EXPECT_THAT(written(), IsEmpty());
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kResourceExhausted, "full"));
  EXPECT_EQ(admission_.calls(), 0u);
}

TEST_F(StreamTest, AbortCancelsTheSourceAndDropsItsReplies) {
  Run();
  Progress("one");
  Progress("two");
  call_->Abort(absl::CancelledError("gone"));
  call_->Abort(absl::UnavailableError("a later reason"));
  EXPECT_TRUE(source_.cancelled);
  EXPECT_FALSE(transport_.finished.has_value()) << "a write is in progress";
  Written(/*ok=*/false);
  EXPECT_THAT(written(), ElementsAre("one"));
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kCancelled, "gone"));
  EXPECT_THAT(observer_.records(), SizeIs(1));
  call_.reset();
  source_.events.on_progress();  // from a window of a call that is gone
  EXPECT_FALSE(source_.events.read_next(1));
  EXPECT_THAT(written(), ElementsAre("one"));
}

TEST_F(StreamTest, FailedWriteEndsTheCall) {
  source_.ready = {"one"};
  Run();
  Written(/*ok=*/false);
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kCancelled, _));
  EXPECT_TRUE(source_.cancelled);
}

TEST_F(StreamTest, IdleCallEndsAtItsDeadline) {
  Run();
  clock_.Advance(milliseconds(3600 * 1000 - 1));
  call_->CheckTime(clock_.Now());
  EXPECT_FALSE(transport_.finished.has_value());
  clock_.Advance(milliseconds(1));
  call_->CheckTime(clock_.Now());
  EXPECT_TRUE(source_.cancelled);
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kDeadlineExceeded, _));
}

TEST_F(StreamTest, StalledReaderEndsTheCall) {
  source_.ready = {"one", "two"};
  Run();
  clock_.Advance(seconds(29));
  call_->CheckTime(clock_.Now());
  Written();
  clock_.Advance(seconds(29));
  call_->CheckTime(clock_.Now());
  EXPECT_EQ(transport_.broken_off, 0) << "each reply has its own time limit";
  clock_.Advance(seconds(1));
  call_->CheckTime(clock_.Now());
  EXPECT_EQ(transport_.broken_off, 1);
  EXPECT_TRUE(source_.cancelled);
  EXPECT_FALSE(transport_.finished.has_value()) << "its write has not come back";
  Written(/*ok=*/false);
  EXPECT_THAT(*transport_.finished,
              StatusIs(StatusCode::kDeadlineExceeded, HasSubstr("write_timeout_seconds = 30")));
  EXPECT_EQ(admission_.calls(), 0u);
}

TEST_F(StreamTest, WriteThatCompletesDuringAnAbortKeepsTheTransport) {
  source_.ready = {"one"};
  Run();
  transport_.on_break_off = [this] {
    Written(/*ok=*/false);
    EXPECT_FALSE(transport_.finished.has_value()) << "the transport would be gone";
  };
  clock_.Advance(seconds(30));
  call_->CheckTime(clock_.Now());
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kDeadlineExceeded, _));
}

TEST_F(StreamTest, WriteOfAnAbortedCallCanBeBrokenOff) {
  source_.ready = {"one"};
  Run();
  call_->BreakOffWrite();
  EXPECT_EQ(transport_.broken_off, 0) << "the call goes on";
  call_->Abort(absl::UnavailableError("shutting down"));
  call_->BreakOffWrite();
  EXPECT_THAT(transport_.broken_off_with, StatusIs(StatusCode::kUnavailable, "shutting down"));
  Written(/*ok=*/false);
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kUnavailable, "shutting down"));
}

// Looks, when a call is reported, at what others can see and do at that moment.
class ProbingObserver final : public metrics::CallObserver {
 public:
  explicit ProbingObserver(const Admission& admission) : admission_(admission) {}
  void CallStarted(const metrics::MethodInfo&) override {}
  void CallFinished(const metrics::CallRecord&) override {
    calls_when_reported = admission_.calls();
    call->Abort(absl::CancelledError("late"));  // would wait for itself if the call were locked
  }

  std::optional<std::size_t> calls_when_reported;
  Call* call = nullptr;

 private:
  const Admission& admission_;
};

TEST_F(StreamTest, IsReportedUnderNoLockAndWithoutItsPlace) {
  ProbingObserver probe(admission_);
  observers_ = {&probe};
  call_ = Receive(transport_);
  probe.call = call_.get();
  ASSERT_TRUE(call_->OnFirstMessage());
  Run();
  call_->Abort(absl::CancelledError("gone"));
  EXPECT_EQ(probe.calls_when_reported, 0u);
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kCancelled, "gone"));
}

// A call that takes several messages.
class FurtherMessagesTest : public StreamTest {
 protected:
  void SetUp() override {
    StreamTest::SetUp();
    CallTest::Run(*call_, /*takes_messages=*/true);
  }
};

TEST_F(FurtherMessagesTest, AreReadOnlyOnRequestOneAtATime) {
  EXPECT_EQ(transport_.reads, 0);
  EXPECT_TRUE(source_.events.read_next(30));
  EXPECT_EQ(transport_.reads, 1);
  EXPECT_FALSE(call_->ReadNext(30)) << "a message is being read already";
  EXPECT_EQ(transport_.reads, 1);
  call_->OnMessage(Bytes(3));
  EXPECT_TRUE(call_->ReadNext(30));
  call_->OnMessage(Bytes(5));
  ASSERT_THAT(source_.messages, SizeIs(2));
  EXPECT_EQ(source_.messages[0]->frames().first_frame(), 3u);
  EXPECT_EQ(source_.messages[1]->frames().first_frame(), 5u);
  EXPECT_EQ(source_.ends, 0);
}

TEST_F(FurtherMessagesTest, SourceMayReadWhileItIsAsked) {
  bool reads = false;
  source_.on_next = [&] { reads = call_->ReadNext(30); };
  source_.events.on_progress();
  EXPECT_TRUE(reads);
}

TEST_F(FurtherMessagesTest, EndOfMessagesLeavesTheCallRunning) {
  EXPECT_TRUE(call_->ReadNext(30));
  call_->OnEndOfMessages();
  EXPECT_EQ(source_.ends, 1);
  EXPECT_FALSE(call_->ReadNext(30)) << "there are no more messages";
  call_->Drain();
  EXPECT_EQ(source_.drains, 0) << "no message is taken";
  EXPECT_FALSE(transport_.finished.has_value());
}

TEST_F(FurtherMessagesTest, MessageThatDoesNotArriveInTimeEndsTheCall) {
  EXPECT_TRUE(call_->ReadNext(5));
  call_->OnMessage(Bytes(1));
  clock_.Advance(seconds(60));
  call_->CheckTime(clock_.Now());
  EXPECT_FALSE(transport_.finished.has_value()) << "none is read";
  EXPECT_TRUE(call_->ReadNext(5));
  clock_.Advance(milliseconds(4999));
  call_->CheckTime(clock_.Now());
  EXPECT_FALSE(transport_.finished.has_value());
  clock_.Advance(milliseconds(1));
  call_->CheckTime(clock_.Now());
  EXPECT_THAT(*transport_.finished,
              StatusIs(StatusCode::kDeadlineExceeded, HasSubstr("live_idle_seconds = 5")));
}

TEST_F(FurtherMessagesTest, MessagesAfterTheEndAreDropped) {
  EXPECT_TRUE(call_->ReadNext(30));
  call_->Abort(absl::CancelledError("gone"));
  call_->OnMessage(Bytes(3));
  call_->OnEndOfMessages();
  EXPECT_THAT(source_.messages, IsEmpty());
  EXPECT_EQ(source_.ends, 0);
  EXPECT_FALSE(call_->ReadNext(30)) << "the transport may be gone";
  EXPECT_EQ(transport_.reads, 1);
}

TEST_F(FurtherMessagesTest, DrainIsReportedOnce) {
  call_->Drain();
  call_->Drain();
  EXPECT_EQ(source_.drains, 1);
  EXPECT_FALSE(transport_.finished.has_value());
  EXPECT_TRUE(call_->ReadNext(30));
}

TEST(RequestIdTest, MakesDistinctOnes) {
  std::set<std::string> ids;
  for (int i = 0; i < 1000; ++i) {
    const std::string id = NewRequestId();
    EXPECT_EQ(id.size(), 32u);
    EXPECT_TRUE(base::IsRequestId(id));
    ids.insert(id);
  }
  EXPECT_EQ(ids.size(), 1000u);
}

TEST(TraceparentTest, HasTheW3cForm) {
  EXPECT_TRUE(IsTraceparent("00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"));
  for (const char* text : {"", "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-0",
                           "00-4BF92F3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01",
                           "00-4bf92f3577b34da6a3ce929d0e0e473g-00f067aa0ba902b7-01",
                           "00x4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"}) {
    EXPECT_FALSE(IsTraceparent(text)) << text;
  }
}

TEST(ClientTest, IsAnAddressANetworkOfIpv6OrElseThePeer) {
  const std::pair<const char*, const char*> cases[] = {
      {"ipv4:192.0.2.7:4711", "ipv4:192.0.2.7"},
      {"ipv6:%5B2001:db8:1:2:3:4:5:6%5D:4711", "ipv6:2001:db8:1:2::/64"},
      {"ipv6:%5B2001:db8:1:2::9%5D:1", "ipv6:2001:db8:1:2::/64"},
      {"ipv6:%5B::ffff:192.0.2.7%5D:4711", "ipv4:192.0.2.7"},
      {"unix:/run/duet.sock", "unix:/run/duet.sock"},
      {"", ""},
      {"ipv6:nonsense", "ipv6"}};
  for (const auto& [peer, client] : cases) EXPECT_EQ(ClientOf(peer), client);
}

}  // namespace
}  // namespace duet::server::service
