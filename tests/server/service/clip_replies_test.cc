#include "server/service/clip_replies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "server/service/admission.h"
#include "server/service/call.h"
#include "server/service/refusals.h"
#include "tests/server/support/fake_clock.h"
#include "tests/server/support/fake_transport.h"
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
    Call::Parts parts;
    parts.transport = &transport_;
    parts.admission = &admission_;
    parts.clock = &clock_;
    parts.scope = std::move(scope);
    parts.client = "client";
    parts.place = *std::move(place);
    call_ = Call::Create(std::move(parts));
    ASSERT_TRUE(call_->OnFirstMessage());
    ClipStreamOptions options;
    options.buffered_frames = 240;
    options.client = "client";
    auto replies =
        std::make_unique<ClipReplies>(std::move(model), *std::move(request), options, scheduler_,
                                      ServerBuild{"cpu, f32, AVX2", "1.0.0"});
    stream_.source = std::move(replies);
  }

  void Start() { call_->Run(std::move(stream_)); }
  void Written(bool ok = true) { transport_.Written(*call_, ok); }

  FakeClock clock_;
  RecordingObserver observer_;
  std::vector<metrics::CallObserver*> observers_ = {&observer_};
  Admission admission_{[] {
    AdmissionLimits limits;
    limits.max_calls = 4;
    return limits;
  }()};
  PuppetScheduler scheduler_;
  test::FakeTransport<v1::SynthesizeResponse> transport_;
  std::shared_ptr<Call> call_;
  Call::Stream stream_;

  ClipRepliesTest() { admission_.SetState(Admission::State::kServing); }
};

TEST_F(ClipRepliesTest, WritesOneMessageAtATimeAndThenEnds) {
  Create(46);
  Start();
  ASSERT_THAT(transport_.replies, SizeIs(1));
  EXPECT_TRUE(transport_.replies[0].has_header());
  EXPECT_EQ(transport_.replies[0].header().rig_size(), 0);
  EXPECT_EQ(transport_.replies[0].header().engine(), "cpu, f32, AVX2");
  EXPECT_EQ(transport_.replies[0].header().server_version(), "1.0.0");
  scheduler_.RunNext();
  EXPECT_THAT(transport_.replies, SizeIs(1)) << "the header is still under way";
  Written();
  ASSERT_THAT(transport_.replies, SizeIs(2));
  EXPECT_EQ(transport_.replies[1].chunk().frame_count(), 30u);
  EXPECT_EQ(transport_.replies[1].chunk().rotations_size(), 0);
  Written();
  EXPECT_EQ(transport_.replies[2].chunk().frame_count(), 16u);
  Written();
  EXPECT_TRUE(transport_.replies[3].has_summary());
  EXPECT_FALSE(transport_.finished.has_value());
  Written();
  ASSERT_TRUE(transport_.finished.has_value());
  EXPECT_THAT(*transport_.finished, IsOk());
}

TEST_F(ClipRepliesTest, WaitsForTheNextWindowWithoutAPendingWrite) {
  Create(46);
  Start();
  Written();
  EXPECT_FALSE(transport_.writing);
  scheduler_.RunNext();
  EXPECT_TRUE(transport_.writing);
}

TEST_F(ClipRepliesTest, RotationsMakeTheHeaderWaitForTheFirstFrames) {
  v1::SynthesizeRequest request = SampleRequest(46);
  request.set_reply_rotations(true);
  Create(request);
  Start();
  EXPECT_FALSE(transport_.writing);
  scheduler_.RunNext();
  ASSERT_THAT(transport_.replies, SizeIs(1));
  const int joints = transport_.replies[0].header().rig_size();
  EXPECT_GT(joints, 15);
  Written();
  Written();
  Written();
  ASSERT_THAT(transport_.replies, SizeIs(4));
  EXPECT_EQ(transport_.replies[1].chunk().frame_count(), 30u);
  EXPECT_EQ(transport_.replies[1].chunk().rotations_size(), 30 * joints * 4);
  EXPECT_EQ(transport_.replies[2].chunk().first_frame(), 30u);
  EXPECT_EQ(transport_.replies[2].chunk().rotations_size(), 16 * joints * 4);
  EXPECT_EQ(transport_.replies[3].summary().frame_count(), 46u);
}

TEST_F(ClipRepliesTest, AModelThatFailsAtOnceSendsNoHeaderWithRotations) {
  auto model = std::make_shared<FakeSynthesizer>();
  model->window_status = [](const engine::SynthesisWindow&) {
    return absl::InternalError("no result");
  };
  v1::SynthesizeRequest request = SampleRequest(46);
  request.set_reply_rotations(true);
  Create(request, model);
  Start();
  scheduler_.RunNext();
  EXPECT_THAT(transport_.replies, IsEmpty());
  ASSERT_TRUE(transport_.finished.has_value());
  EXPECT_EQ(transport_.finished->code(), StatusCode::kInternal);
}

TEST_F(ClipRepliesTest, RejectionPrecedesEveryMessage) {
  Create(46);
  scheduler_.Refuse(absl::ResourceExhaustedError("full"));
  Start();
  EXPECT_THAT(transport_.replies, IsEmpty());
  ASSERT_TRUE(transport_.finished.has_value());
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kResourceExhausted, "full"));
}

TEST_F(ClipRepliesTest, FailedWriteEndsTheCall) {
  Create(46);
  Start();
  Written(/*ok=*/false);
  ASSERT_TRUE(transport_.finished.has_value());
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kCancelled, testing::_));
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
  Start();
  Written();
  EXPECT_TRUE(scheduler_.RunNext());
  EXPECT_THAT(transport_.replies, SizeIs(1));
  EXPECT_THAT(*transport_.finished, StatusIs(StatusCode::kCancelled, "gone"));
}

TEST_F(ClipRepliesTest, FailedWindowEndsTheCallDespiteRemainingFrames) {
  auto model = std::make_shared<FakeSynthesizer>();
  int windows = 0;
  model->window_status = [&windows](const engine::SynthesisWindow&) {
    return ++windows == 2 ? absl::InternalError("broken") : absl::OkStatus();
  };
  Create(200, model);
  Start();
  scheduler_.RunNext();
  scheduler_.RunNext();
  Written();
  ASSERT_TRUE(transport_.finished.has_value());
  EXPECT_EQ(transport_.finished->code(), StatusCode::kInternal);
}

TEST_F(ClipRepliesTest, MeasuresTheFirstChunkAndTheWhole) {
  Create(46);
  Start();
  Written();
  clock_.Advance(std::chrono::milliseconds(200));
  scheduler_.RunNext();
  clock_.Advance(std::chrono::milliseconds(300));
  while (transport_.writing) Written();
  const metrics::CallRecord record = observer_.WaitFor(1);
  EXPECT_DOUBLE_EQ(record.first_chunk_seconds, 0.2);
  EXPECT_DOUBLE_EQ(record.total_seconds, 0.5);
}

TEST_F(ClipRepliesTest, CallWithoutChunksReportsNoFirstChunk) {
  Create(46);
  Start();
  call_->Abort(absl::CancelledError("gone"));
  Written(/*ok=*/false);
  EXPECT_LT(observer_.WaitFor(1).first_chunk_seconds, 0);
}

}  // namespace
}  // namespace duet::server::service
