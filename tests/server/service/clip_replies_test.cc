#include "server/service/clip_replies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "server/service/admission.h"
#include "server/service/refusals.h"
#include "server/service/streaming_call.h"
#include "tests/server/support/fake_clock.h"
#include "tests/server/support/puppet_scheduler.h"
#include "tests/server/support/recording_observer.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::FakeClock;
using test::FakeSynthesizer;
using test::PuppetScheduler;
using test::RecordingObserver;
using test::SampleRequest;

using absl::StatusCode;

// A reader that the test steps.
class FakeWriter final : public ReplyWriter {
 public:
  void Write(const google::protobuf::Message& reply) override {
    EXPECT_FALSE(writing) << "two writes at once";
    EXPECT_FALSE(finished.has_value()) << "a write after the end";
    writing = true;
    replies.push_back(dynamic_cast<const v1::SynthesizeResponse&>(reply));
  }
  void Finish(CallScope& scope, const absl::Status& status) override {
    EXPECT_FALSE(writing) << "the end while a write is under way";
    EXPECT_FALSE(finished.has_value()) << "two ends";
    scope.Finish(status);
    finished = status;
  }

  void BreakOff(const absl::Status& reason) override {
    ++broken_off;
    broken_off_with = reason;
    if (on_break_off) on_break_off();
  }

  bool writing = false;
  int broken_off = 0;
  absl::Status broken_off_with;
  std::function<void()> on_break_off;
  std::vector<v1::SynthesizeResponse> replies;
  std::optional<absl::Status> finished;
};

class ClipRepliesTest : public ::testing::Test {
 protected:
  void Create(int frames,
              std::shared_ptr<FakeSynthesizer> model = std::make_shared<FakeSynthesizer>()) {
    Create(SampleRequest(frames), std::move(model));
  }

  void Create(const v1::SynthesizeRequest& message,
              std::shared_ptr<FakeSynthesizer> model = std::make_shared<FakeSynthesizer>()) {
    absl::StatusOr<ValidatedRequest> request =
        ValidateRequest(message, model->description(), RequestLimits());
    ASSERT_THAT(request, IsOk());
    absl::StatusOr<ShareLease> place = admission_.Admit("client");
    ASSERT_THAT(place, IsOk());
    auto scope =
        std::make_unique<CallScope>(metrics::MethodInfo{"service", "Synthesize", "server_stream"},
                                    CallIdentity{"id", "", "peer", "client"}, observers_, clock_);
    StreamingCall::Parts parts;
    parts.place = *std::move(place);
    parts.scope = std::move(scope);
    parts.deadline = deadline_;
    parts.write_timeout_seconds = 30;
    parts.clock = &clock_;
    ClipStreamOptions options;
    options.deadline = deadline_;
    options.buffered_frames = 240;
    options.client = "client";
    auto replies =
        std::make_unique<ClipReplies>(std::move(model), *std::move(request), options, scheduler_,
                                      ServerBuild{"cpu, f32, AVX2", "1.0.0"});
    call_ = StreamingCall::Create(std::move(parts), std::move(replies), writer_);
  }

  // The reader took the message under way.
  void Written(bool ok = true) {
    ASSERT_TRUE(writer_.writing);
    writer_.writing = false;
    call_->OnWritten(ok);
  }

  FakeClock clock_;
  RecordingObserver observer_;
  std::vector<metrics::CallObserver*> observers_ = {&observer_};
  Admission admission_{[] {
    AdmissionLimits limits;
    limits.max_calls = 4;
    return limits;
  }()};
  common::TimePoint deadline_ = common::TimePoint::max();
  PuppetScheduler scheduler_;
  FakeWriter writer_;
  std::shared_ptr<StreamingCall> call_;

  ClipRepliesTest() { admission_.SetState(Admission::State::kServing); }
};

TEST_F(ClipRepliesTest, WritesOneMessageAtATimeAndThenEnds) {
  Create(46);
  call_->Start();
  ASSERT_THAT(writer_.replies, SizeIs(1));
  EXPECT_TRUE(writer_.replies[0].has_header());
  EXPECT_EQ(writer_.replies[0].header().rig_size(), 0);
  EXPECT_EQ(writer_.replies[0].header().engine(), "cpu, f32, AVX2");
  EXPECT_EQ(writer_.replies[0].header().server_version(), "1.0.0");
  scheduler_.RunNext();
  EXPECT_THAT(writer_.replies, SizeIs(1)) << "the header is still under way";
  Written();
  ASSERT_THAT(writer_.replies, SizeIs(2));
  EXPECT_EQ(writer_.replies[1].chunk().frame_count(), 30u);
  EXPECT_EQ(writer_.replies[1].chunk().rotations_size(), 0);
  Written();
  EXPECT_EQ(writer_.replies[2].chunk().frame_count(), 16u);
  Written();
  EXPECT_TRUE(writer_.replies[3].has_summary());
  EXPECT_FALSE(writer_.finished.has_value());
  Written();
  ASSERT_TRUE(writer_.finished.has_value());
  EXPECT_THAT(*writer_.finished, IsOk());
}

TEST_F(ClipRepliesTest, WaitsForTheNextWindowWithoutAPendingWrite) {
  Create(46);
  call_->Start();
  Written();
  EXPECT_FALSE(writer_.writing);
  scheduler_.RunNext();
  EXPECT_TRUE(writer_.writing);
}

TEST_F(ClipRepliesTest, RotationsMakeTheHeaderWaitForTheFirstFrames) {
  v1::SynthesizeRequest request = SampleRequest(46);
  request.set_reply_rotations(true);
  Create(request);
  call_->Start();
  EXPECT_FALSE(writer_.writing);
  scheduler_.RunNext();
  ASSERT_THAT(writer_.replies, SizeIs(1));
  const int joints = writer_.replies[0].header().rig_size();
  EXPECT_GT(joints, 15);
  Written();
  Written();
  Written();
  ASSERT_THAT(writer_.replies, SizeIs(4));
  EXPECT_EQ(writer_.replies[1].chunk().frame_count(), 30u);
  EXPECT_EQ(writer_.replies[1].chunk().rotations_size(), 30 * joints * 4);
  EXPECT_EQ(writer_.replies[2].chunk().first_frame(), 30u);
  EXPECT_EQ(writer_.replies[2].chunk().rotations_size(), 16 * joints * 4);
  EXPECT_EQ(writer_.replies[3].summary().frame_count(), 46u);
}

TEST_F(ClipRepliesTest, AModelThatFailsAtOnceSendsNoHeaderWithRotations) {
  auto model = std::make_shared<FakeSynthesizer>();
  model->window_status = [](const engine::SynthesisWindow&) {
    return absl::InternalError("no result");
  };
  v1::SynthesizeRequest request = SampleRequest(46);
  request.set_reply_rotations(true);
  Create(request, model);
  call_->Start();
  scheduler_.RunNext();
  EXPECT_THAT(writer_.replies, IsEmpty());
  ASSERT_TRUE(writer_.finished.has_value());
  EXPECT_EQ(writer_.finished->code(), StatusCode::kInternal);
}

TEST_F(ClipRepliesTest, RejectionPrecedesEveryMessage) {
  Create(46);
  scheduler_.Refuse(absl::ResourceExhaustedError("full"));
  call_->Start();
  EXPECT_THAT(writer_.replies, IsEmpty());
  ASSERT_TRUE(writer_.finished.has_value());
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kResourceExhausted, "full"));
}

TEST_F(ClipRepliesTest, ReleasesItsPlaceAndReportsBeforeTheStatusIsSent) {
  Create(46);
  scheduler_.Refuse(absl::ResourceExhaustedError("full"));
  EXPECT_EQ(admission_.calls(), 1u);
  call_->Start();
  EXPECT_EQ(admission_.calls(), 0u);
  EXPECT_THAT(observer_.records(), SizeIs(1));
}

// Looks, when a call is reported, at what others can see and do at that moment.
class ProbingObserver final : public metrics::CallObserver {
 public:
  explicit ProbingObserver(const Admission& admission) : admission_(admission) {}
  void CallStarted(const metrics::MethodInfo&) override {}
  void CallFinished(const metrics::CallRecord&) override {
    calls_when_reported = admission_.calls();
    if (call != nullptr) call->Abort(absl::CancelledError("late"));
  }

  std::optional<std::size_t> calls_when_reported;
  StreamingCall* call = nullptr;

 private:
  const Admission& admission_;
};

TEST_F(ClipRepliesTest, ItsPlaceIsFreeWhenItIsReported) {
  ProbingObserver probe(admission_);
  observers_ = {&probe};
  Create(46);
  call_->Start();
  call_->Abort(absl::CancelledError("gone"));
  Written(/*ok=*/false);
  EXPECT_EQ(probe.calls_when_reported, 0u);
}

TEST_F(ClipRepliesTest, IsReportedUnderNoLock) {
  ProbingObserver probe(admission_);
  observers_ = {&probe};
  Create(46);
  probe.call = call_.get();
  call_->Start();
  call_->Abort(absl::CancelledError("gone"));
  Written(/*ok=*/false);  // would wait for itself if the call were locked
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kCancelled, "gone"));
}

TEST_F(ClipRepliesTest, AnAbortWhileIdleEndsAtOnce) {
  Create(46);
  call_->Start();
  Written();
  call_->Abort(absl::CancelledError("gone"));
  ASSERT_TRUE(writer_.finished.has_value());
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kCancelled, "gone"));
}

TEST_F(ClipRepliesTest, AbortWaitsForTheWriteInProgress) {
  Create(46);
  call_->Start();
  call_->Abort(absl::CancelledError("gone"));
  EXPECT_FALSE(writer_.finished.has_value());
  Written(/*ok=*/false);
  ASSERT_TRUE(writer_.finished.has_value());
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kCancelled, "gone"));
}

TEST_F(ClipRepliesTest, TheFirstReasonToEndCounts) {
  Create(46);
  call_->Start();
  call_->Abort(DrainingRefusal());
  call_->Abort(absl::CancelledError("gone"));
  Written(/*ok=*/false);
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kUnavailable, testing::_));
  EXPECT_THAT(observer_.records(), SizeIs(1));
}

TEST_F(ClipRepliesTest, FailedWriteEndsTheCall) {
  Create(46);
  call_->Start();
  Written(/*ok=*/false);
  ASSERT_TRUE(writer_.finished.has_value());
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kCancelled, testing::_));
  EXPECT_FALSE(scheduler_.RunNext()) << "its window was evaluated";
}

TEST_F(ClipRepliesTest, StalledReaderEndsTheCall) {
  Create(46);
  call_->Start();
  clock_.Advance(std::chrono::seconds(29));
  call_->CheckTime(clock_.Now());
  EXPECT_EQ(writer_.broken_off, 0);
  clock_.Advance(std::chrono::seconds(1));
  call_->CheckTime(clock_.Now());
  EXPECT_EQ(writer_.broken_off, 1);
  EXPECT_FALSE(writer_.finished.has_value()) << "its write has not come back";
  Written(/*ok=*/false);
  ASSERT_TRUE(writer_.finished.has_value());
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kDeadlineExceeded,
                                          testing::HasSubstr("write_timeout_seconds = 30")));
  EXPECT_EQ(admission_.calls(), 0u);
  EXPECT_FALSE(scheduler_.RunNext()) << "its window was evaluated";
}

TEST_F(ClipRepliesTest, SlowReaderWithinTheTimeLimitKeepsTheCall) {
  Create(46);
  call_->Start();
  scheduler_.RunNext();
  while (writer_.writing) {
    clock_.Advance(std::chrono::seconds(29));
    call_->CheckTime(clock_.Now());
    Written();
  }
  EXPECT_THAT(*writer_.finished, IsOk());
  EXPECT_EQ(writer_.broken_off, 0);
}

TEST_F(ClipRepliesTest, WriteThatCompletesDuringAnAbortKeepsTheWriter) {
  Create(46);
  call_->Start();
  writer_.on_break_off = [this] {
    Written(/*ok=*/false);
    EXPECT_FALSE(writer_.finished.has_value()) << "the writer would be gone";
  };
  clock_.Advance(std::chrono::seconds(30));
  call_->CheckTime(clock_.Now());
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kDeadlineExceeded, testing::_));
}

TEST_F(ClipRepliesTest, CallEndsAtItsDeadline) {
  deadline_ = clock_.Now() + std::chrono::seconds(5);
  Create(46);
  call_->Start();
  Written();
  clock_.Advance(std::chrono::milliseconds(4999));
  call_->CheckTime(clock_.Now());
  EXPECT_FALSE(writer_.finished.has_value());
  clock_.Advance(std::chrono::milliseconds(1));
  call_->CheckTime(clock_.Now());
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kDeadlineExceeded, testing::_));
  EXPECT_FALSE(scheduler_.RunNext()) << "its window was evaluated";
}

TEST_F(ClipRepliesTest, WindowThatEndsAfterTheCallIsDiscarded) {
  auto model = std::make_shared<FakeSynthesizer>();
  // The caller goes away, writer and all, while its window is being evaluated.
  model->on_batch = [this](absl::Span<const engine::SynthesisWindow* const>) {
    call_->Abort(absl::CancelledError("gone"));
    call_.reset();
  };
  Create(46, model);
  call_->Start();
  Written();
  EXPECT_TRUE(scheduler_.RunNext());
  EXPECT_THAT(writer_.replies, SizeIs(1));
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kCancelled, "gone"));
}

TEST_F(ClipRepliesTest, FailedWindowEndsTheCallDespiteRemainingFrames) {
  auto model = std::make_shared<FakeSynthesizer>();
  int windows = 0;
  model->window_status = [&windows](const engine::SynthesisWindow&) {
    return ++windows == 2 ? absl::InternalError("broken") : absl::OkStatus();
  };
  Create(200, model);
  call_->Start();
  scheduler_.RunNext();
  scheduler_.RunNext();
  Written();
  ASSERT_TRUE(writer_.finished.has_value());
  EXPECT_EQ(writer_.finished->code(), StatusCode::kInternal);
}

TEST_F(ClipRepliesTest, MeasuresTheFirstChunkAndTheWhole) {
  Create(46);
  call_->Start();
  Written();
  clock_.Advance(std::chrono::milliseconds(200));
  scheduler_.RunNext();
  clock_.Advance(std::chrono::milliseconds(300));
  while (writer_.writing) Written();
  const metrics::CallRecord record = observer_.WaitFor(1);
  EXPECT_DOUBLE_EQ(record.first_chunk_seconds, 0.2);
  EXPECT_DOUBLE_EQ(record.total_seconds, 0.5);
}

TEST_F(ClipRepliesTest, CallWithoutChunksReportsNoFirstChunk) {
  Create(46);
  call_->Start();
  call_->Abort(absl::CancelledError("gone"));
  Written(/*ok=*/false);
  EXPECT_LT(observer_.WaitFor(1).first_chunk_seconds, 0);
}

TEST_F(ClipRepliesTest, EndingAStalledCallReleasesItsPlaceImmediately) {
  Create(46);
  call_->Start();
  EXPECT_EQ(call_->waiting_since(), clock_.Now());
  clock_.Advance(std::chrono::seconds(2));
  EXPECT_TRUE(call_->GiveUpReader(clock_.Now(), 2).has_value());
  EXPECT_EQ(admission_.calls(), 0u) << "although the write is still under way";
  EXPECT_EQ(writer_.broken_off, 1);
  EXPECT_THAT(writer_.broken_off_with,
              StatusIs(StatusCode::kResourceExhausted, HasSubstr("while other calls")));
  EXPECT_FALSE(writer_.finished.has_value());
  Written(/*ok=*/false);
  ASSERT_TRUE(writer_.finished.has_value());
  EXPECT_THAT(*writer_.finished,
              StatusIs(StatusCode::kResourceExhausted, HasSubstr("while other calls")));
}

TEST_F(ClipRepliesTest, StalledReaderIsEndedOnlyOnce) {
  Create(46);
  call_->Start();
  EXPECT_TRUE(call_->GiveUpReader(clock_.Now(), 0).has_value());
  EXPECT_FALSE(call_->GiveUpReader(clock_.Now(), 0).has_value());
  EXPECT_EQ(call_->waiting_since(), std::nullopt);
  EXPECT_EQ(writer_.broken_off, 1);
  Written(/*ok=*/false);
}

TEST_F(ClipRepliesTest, ActiveReaderKeepsItsCall) {
  Create(46);
  call_->Start();
  clock_.Advance(std::chrono::seconds(1));
  EXPECT_FALSE(call_->GiveUpReader(clock_.Now(), 2).has_value()) << "it has not waited long enough";
  Written();
  clock_.Advance(std::chrono::seconds(10));
  EXPECT_EQ(call_->waiting_since(), std::nullopt);
  EXPECT_FALSE(call_->GiveUpReader(clock_.Now(), 2).has_value()) << "it waits for the model";
  EXPECT_EQ(writer_.broken_off, 0);
  EXPECT_EQ(admission_.calls(), 1u);
  call_->Abort(absl::CancelledError("the test is over"));
}

TEST_F(ClipRepliesTest, EndedCallKeepsItsReasonWhenItsReaderStalls) {
  Create(46);
  call_->Start();
  call_->Abort(absl::UnavailableError("the server is shutting down"));
  EXPECT_FALSE(writer_.finished.has_value()) << "the header is still under way";
  EXPECT_TRUE(call_->GiveUpReader(clock_.Now(), 0).has_value());
  EXPECT_THAT(writer_.broken_off_with,
              StatusIs(StatusCode::kUnavailable, HasSubstr("shutting down")));
  Written(/*ok=*/false);
  EXPECT_THAT(*writer_.finished, StatusIs(StatusCode::kUnavailable, HasSubstr("shutting down")));
}

}  // namespace
}  // namespace duet::server::service
