#include "server/service/reception.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "server/service/refusals.h"
#include "tests/server/support/fake_clock.h"
#include "tests/server/support/recording_observer.h"
#include "tests/server/support/refusal.h"
#include "tests/support/status_matchers.h"

namespace duet::server::service {
namespace {

using test::FakeClock;
using test::RecordingObserver;
using test::StatusIs;

using ::testing::_;

using absl::StatusCode;
using std::chrono::milliseconds;

class FakeWriter final : public ReplyWriter {
 public:
  void Write(const v1::SynthesizeResponse&) override { ADD_FAILURE() << "nothing to write"; }
  void BreakOff(const absl::Status&) override { ADD_FAILURE() << "nothing to break off"; }
  void Finish(CallScope& scope, const absl::Status& status) override {
    EXPECT_FALSE(finished.has_value()) << "two ends";
    scope.Finish(status);
    finished = status;
  }
  std::optional<absl::Status> finished;
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
};

TEST_F(ReceptionTest, AMessageThatComesIsToBeAnswered) {
  const auto reception = Receive(writer_);
  EXPECT_TRUE(reception->Received());
  EXPECT_FALSE(writer_.finished.has_value());
  reception->Refuse(absl::NotFoundError("no such model"));
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kNotFound, _));
  EXPECT_EQ(admission_.calls(), 0u);
}

TEST_F(ReceptionTest, ACallerThatGoesAwayBeforeItsMessageIsCancelledNotMalformed) {
  const auto reception = Receive(writer_);
  reception->Lost(/*cancelled=*/true);
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kCancelled, _));
  EXPECT_EQ(admission_.calls(), 0u);
}

TEST_F(ReceptionTest, ACallThatEndsWithoutAMessageIsMalformed) {
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

TEST_F(ReceptionTest, AMessageThatHasComeNoLongerArrivesSlowly) {
  FakeWriter other_writer;
  const auto first = Receive(writer_), second = Receive(other_writer);
  first->CheckTime(clock_.Now() + std::chrono::seconds(1));
  ASSERT_TRUE(first->Received());
  second->CheckTime(clock_.Now() + std::chrono::seconds(1));
  EXPECT_FALSE(other_writer.finished.has_value()) << "the only leave to arrive slowly was kept";
}

TEST_F(ReceptionTest, AnEndThatComesWhileTheMessageIsHandledWaitsForThat) {
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

TEST_F(ReceptionTest, AMessageThatIsLongOnItsWayNeedsLeave) {
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

TEST_F(ReceptionTest, AMessageThatHasComeNeedsNoMoreLeave) {
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

TEST_F(ReceptionTest, AMessageThatTakesTooLongIsNotWaitedFor) {
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

}  // namespace
}  // namespace duet::server::service
