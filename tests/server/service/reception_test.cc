#include "server/service/reception.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/service/refusals.h"
#include "tests/server/support/fake_clock.h"
#include "tests/server/support/recording_observer.h"
#include "tests/server/support/refusal.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::FakeClock;
using test::RecordingObserver;

using ::testing::_;

using absl::StatusCode;
using std::chrono::milliseconds;

class FakeWriter final : public ReplyWriter {
 public:
  void Write(const google::protobuf::Message&) override { ADD_FAILURE() << "nothing to write"; }
  void BreakOff(const absl::Status&) override { ADD_FAILURE() << "nothing to break off"; }
  void Finish(CallScope& scope, const absl::Status& status) override {
    EXPECT_FALSE(finished.has_value()) << "two ends";
    scope.Finish(status);
    finished = status;
  }
  std::optional<absl::Status> finished;
};

// Counts the reads that a reception begins.
class FakeReader final : public MessageReader {
 public:
  void Read() override { ++reads; }
  int reads = 0;
};

class ReceptionTest : public ::testing::Test {
 protected:
  ReceptionTest() : admission_(Limits()) { admission_.SetState(Admission::State::kServing); }

  static AdmissionLimits Limits() {
    AdmissionLimits limits;
    limits.max_calls = 4;
    limits.max_slow_requests = 1;
    return limits;
  }

  std::unique_ptr<Reception> Receive(FakeWriter& writer) {
    Reception::Parts parts;
    parts.writer = &writer;
    parts.reader = &reader_;
    parts.admission = &admission_;
    parts.clock = &clock_;
    parts.limits = {0.1, 30};
    parts.scope =
        std::make_unique<CallScope>(metrics::MethodInfo{"service", "Method", "unary"},
                                    CallIdentity{"id", "", "peer", "client"}, observers_, clock_);
    parts.client = "client";
    parts.place = *admission_.Admit("client");
    return std::make_unique<Reception>(std::move(parts));
  }

  FakeClock clock_;
  RecordingObserver observer_;
  std::vector<metrics::CallObserver*> observers_ = {&observer_};
  Admission admission_;
  FakeWriter writer_;
  FakeReader reader_;
};

TEST_F(ReceptionTest, ArrivedMessageIsHandled) {
  const auto reception = Receive(writer_);
  EXPECT_TRUE(reception->Received());
  EXPECT_FALSE(writer_.finished.has_value());
  reception->Refuse(absl::NotFoundError("no such model"));
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kNotFound, _));
  EXPECT_EQ(admission_.calls(), 0u);
}

TEST_F(ReceptionTest, DisconnectBeforeTheMessageIsCancelledNotMalformed) {
  const auto reception = Receive(writer_);
  reception->Lost(/*cancelled=*/true);
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kCancelled, _));
  EXPECT_EQ(admission_.calls(), 0u);
}

TEST_F(ReceptionTest, CallThatEndsWithoutAMessageIsMalformed) {
  const auto reception = Receive(writer_);
  reception->Lost(/*cancelled=*/false);
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kInvalidArgument, _));
}

TEST_F(ReceptionTest, WhatComesAfterTheEndIsNobodys) {
  const auto reception = Receive(writer_);
  reception->Abort(DrainingRefusal());
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kUnavailable, _));
  EXPECT_FALSE(reception->Received());
  reception->Lost(/*cancelled=*/true);
  reception->Abort(absl::CancelledError("late"));
  reception->CheckTime(clock_.Now() + std::chrono::hours(1));
  EXPECT_EQ(observer_.records().size(), 1u);
}

TEST_F(ReceptionTest, ArrivedMessageNoLongerCountsAsSlow) {
  FakeWriter other_writer;
  const auto first = Receive(writer_), second = Receive(other_writer);
  first->CheckTime(clock_.Now() + std::chrono::seconds(1));
  ASSERT_TRUE(first->Received());
  second->CheckTime(clock_.Now() + std::chrono::seconds(1));
  EXPECT_FALSE(other_writer.finished.has_value()) << "the only leave to arrive slowly was kept";
}

TEST_F(ReceptionTest, AbortWaitsForTheMessageBeingHandled) {
  const auto reception = Receive(writer_);
  EXPECT_TRUE(reception->Received());
  EXPECT_FALSE(reception->ended_meanwhile().has_value());
  reception->Abort(absl::CancelledError("gone"));
  EXPECT_THAT(reception->ended_meanwhile().value_or(absl::OkStatus()),
              StatusIs(StatusCode::kCancelled, _));
  reception->CheckTime(clock_.Now() + std::chrono::hours(1));
  EXPECT_FALSE(writer_.finished.has_value());
  const std::unique_ptr<CallScope> scope = reception->Answer();
  EXPECT_NE(scope, nullptr);
}

TEST_F(ReceptionTest, SlowMessageNeedsAdmission) {
  FakeWriter second_writer;
  const auto first = Receive(writer_);
  const auto second = Receive(second_writer);
  clock_.Advance(milliseconds(99));
  first->CheckTime(clock_.Now());
  second->CheckTime(clock_.Now());
  EXPECT_FALSE(writer_.finished.has_value());
  clock_.Advance(milliseconds(1));
  first->CheckTime(clock_.Now());
  first->CheckTime(clock_.Now());  // has leave already
  second->CheckTime(clock_.Now());
  EXPECT_FALSE(writer_.finished.has_value());
  ASSERT_TRUE(second_writer.finished.has_value());
  EXPECT_EQ(second_writer.finished->code(), StatusCode::kResourceExhausted);
  EXPECT_EQ(test::Decode(*second_writer.finished).retry_seconds, 1);

  // The leave ends with the call.
  first->Abort(absl::CancelledError("gone"));
  FakeWriter third_writer;
  const auto third = Receive(third_writer);
  clock_.Advance(milliseconds(100));
  third->CheckTime(clock_.Now());
  EXPECT_FALSE(third_writer.finished.has_value());
}

TEST_F(ReceptionTest, ArrivedMessageNeedsNoAdmissionForSlowOnes) {
  FakeWriter second_writer;
  const auto first = Receive(writer_);
  clock_.Advance(milliseconds(100));
  first->CheckTime(clock_.Now());
  EXPECT_TRUE(first->Received());
  const std::unique_ptr<CallScope> scope = first->Answer();
  const auto second = Receive(second_writer);
  clock_.Advance(milliseconds(100));
  second->CheckTime(clock_.Now());
  EXPECT_FALSE(second_writer.finished.has_value());
}

TEST_F(ReceptionTest, MessageAfterTheTimeoutEndsTheCall) {
  const auto reception = Receive(writer_);
  clock_.Advance(milliseconds(29999));
  reception->CheckTime(clock_.Now());
  EXPECT_FALSE(writer_.finished.has_value());
  clock_.Advance(milliseconds(1));
  reception->CheckTime(clock_.Now());
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kDeadlineExceeded,
                                          ::testing::HasSubstr("receive_timeout_seconds = 30")));
  EXPECT_EQ(admission_.calls(), 0u);
}

// Records the messages after the first one.
class RecordingSink final : public MessageSink {
 public:
  void OnMessage(grpc::ByteBuffer bytes) override { sizes.push_back(bytes.Length()); }
  void OnEndOfMessages() override { ++ends; }
  void OnDraining() override { ++drains; }
  bool OwesAnswers() const override { return owes; }
  bool owes = false;
  std::vector<std::size_t> sizes;
  int ends = 0, drains = 0;
};

// A stream that sends nothing and does not end by itself.
class SilentSource final : public ReplySource {
 public:
  absl::Status Start(std::function<void()>) override { return absl::OkStatus(); }
  NextReply Next(CallScope&) override { return {}; }
  void Cancel() override {}
  void Report(metrics::CallRecord&) const override {}
};

grpc::ByteBuffer Bytes(std::size_t size) {
  const grpc::Slice slice(std::string(size, 'x'));
  return {&slice, 1};
}

// A call that goes on and takes further messages.
class FurtherMessagesTest : public ReceptionTest {
 protected:
  void SetUp() override {
    Begin();
    GoOn();
  }
  void Begin() {
    reception_ = Receive(writer_);
    ASSERT_TRUE(reception_->Received());
  }
  void GoOn() {
    StreamingCall::Parts parts;
    parts.scope = reception_->TakeScope();
    parts.place = reception_->TakePlace();
    parts.clock = &clock_;
    call_ = StreamingCall::Create(std::move(parts), std::make_unique<SilentSource>(), writer_);
    reception_->GoOn(call_, sink_);
  }

  std::unique_ptr<Reception> reception_;
  std::shared_ptr<StreamingCall> call_;
  std::shared_ptr<RecordingSink> sink_ = std::make_shared<RecordingSink>();
};

TEST_F(FurtherMessagesTest, AreReadOnlyOnRequestOneAtATime) {
  EXPECT_EQ(reader_.reads, 0);
  EXPECT_TRUE(reception_->ReadNext(30));
  EXPECT_EQ(reader_.reads, 1);
  EXPECT_FALSE(reception_->ReadNext(30)) << "a message is being read already";
  EXPECT_EQ(reader_.reads, 1);
  reception_->HandOn(Bytes(3));
  EXPECT_TRUE(reception_->ReadNext(30));
  reception_->HandOn(Bytes(5));
  EXPECT_THAT(sink_->sizes, ::testing::ElementsAre(3u, 5u));
  EXPECT_EQ(sink_->ends, 0);
}

TEST_F(FurtherMessagesTest, SilenceEndsTheCallInTheNameOfTheSettingOfLiveSessions) {
  EXPECT_TRUE(reception_->ReadNext(4));
  clock_.Advance(milliseconds(4000));
  reception_->CheckTime(clock_.Now());
  ASSERT_TRUE(writer_.finished.has_value());
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kDeadlineExceeded,
                                          ::testing::HasSubstr("live_idle_seconds = 4")));
}

TEST_F(FurtherMessagesTest, EndOfMessagesLeavesTheCallRunning) {
  EXPECT_TRUE(reception_->ReadNext(30));
  reception_->EndOfMessages();
  EXPECT_EQ(sink_->ends, 1);
  EXPECT_FALSE(reception_->ReadNext(30)) << "there are no more messages";
  EXPECT_FALSE(writer_.finished.has_value());
}

TEST_F(FurtherMessagesTest, MessageThatDoesNotArriveInTimeEndsTheCall) {
  EXPECT_TRUE(reception_->ReadNext(5));
  clock_.Advance(milliseconds(4999));
  reception_->CheckTime(clock_.Now());
  EXPECT_FALSE(writer_.finished.has_value());
  clock_.Advance(milliseconds(1));
  reception_->CheckTime(clock_.Now());
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kDeadlineExceeded, _));
}

TEST_F(FurtherMessagesTest, TimeLimitAppliesOnlyWhileAMessageIsRead) {
  EXPECT_TRUE(reception_->ReadNext(5));
  reception_->HandOn(Bytes(1));
  clock_.Advance(std::chrono::hours(1));
  reception_->CheckTime(clock_.Now());
  EXPECT_FALSE(writer_.finished.has_value());
}

TEST_F(FurtherMessagesTest, IdleCallGivesItsPlaceUp) {
  EXPECT_EQ(reception_->idle_since(), std::nullopt) << "no message is read";
  EXPECT_TRUE(reception_->ReadNext(60));
  EXPECT_EQ(reception_->idle_since(), clock_.Now());
  clock_.Advance(milliseconds(4999));
  EXPECT_FALSE(reception_->GiveUpIdle(clock_.Now(), 5));
  clock_.Advance(milliseconds(1));
  EXPECT_EQ(admission_.calls(), 1u);
  EXPECT_TRUE(reception_->GiveUpIdle(clock_.Now(), 5));
  EXPECT_EQ(admission_.calls(), 0u);
  EXPECT_EQ(writer_.finished->code(), StatusCode::kResourceExhausted);
  EXPECT_GT(test::Decode(*writer_.finished).retry_seconds, 0);
  EXPECT_FALSE(reception_->GiveUpIdle(clock_.Now(), 5)) << "only once";
}

TEST_F(FurtherMessagesTest, CallThatOwesAnswersIsNotIdle) {
  EXPECT_TRUE(reception_->ReadNext(60));
  clock_.Advance(std::chrono::seconds(9));
  sink_->owes = true;
  EXPECT_EQ(reception_->idle_since(), std::nullopt);
  EXPECT_FALSE(reception_->GiveUpIdle(clock_.Now(), 5));
  EXPECT_FALSE(writer_.finished.has_value());
}

TEST_F(FurtherMessagesTest, MessagesAfterCloseAreDropped) {
  EXPECT_TRUE(reception_->ReadNext(30));
  reception_->Close();
  reception_->HandOn(Bytes(3));
  reception_->EndOfMessages();
  EXPECT_THAT(sink_->sizes, ::testing::IsEmpty());
  EXPECT_EQ(sink_->ends, 0);
  EXPECT_FALSE(reception_->ReadNext(30)) << "the reader may be gone";
  EXPECT_EQ(reader_.reads, 1);
}

TEST_F(FurtherMessagesTest, DrainIsReportedOnceWhileMessagesAreTaken) {
  EXPECT_EQ(sink_->drains, 0);
  reception_->Drain();
  reception_->Drain();
  EXPECT_EQ(sink_->drains, 1);
  EXPECT_FALSE(writer_.finished.has_value());
  EXPECT_TRUE(reception_->ReadNext(30));
}

TEST_F(FurtherMessagesTest, DrainThatBeginsBeforeTheCallGoesOnIsReported) {
  reception_->Abort(absl::CancelledError("of another test"));
  writer_.finished.reset();
  Begin();
  reception_->Drain();
  EXPECT_EQ(sink_->drains, 0);
  GoOn();
  EXPECT_EQ(sink_->drains, 1);
}

TEST_F(FurtherMessagesTest, DrainIsNotReportedAfterTheLastMessage) {
  EXPECT_TRUE(reception_->ReadNext(30));
  reception_->EndOfMessages();
  reception_->Drain();
  EXPECT_EQ(sink_->drains, 0);
}

TEST_F(ReceptionTest, CallWithoutASinkReadsNoFurtherMessage) {
  const auto reception = Receive(writer_);
  ASSERT_TRUE(reception->Received());
  EXPECT_FALSE(reception->ReadNext(30)) << "its first message is still handled";
  StreamingCall::Parts parts;
  parts.scope = reception->TakeScope();
  parts.clock = &clock_;
  reception->GoOn(
      StreamingCall::Create(std::move(parts), std::make_unique<SilentSource>(), writer_));
  EXPECT_FALSE(reception->ReadNext(30));
  EXPECT_EQ(reader_.reads, 0);
}

}  // namespace
}  // namespace duet::server::service
