#include "server/service/live_replies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/server/support/fakes.h"
#include "tests/server/support/puppet_scheduler.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::AddWeight;
using test::FakeClock;
using test::FakeSynthesizer;
using test::PuppetScheduler;

using absl::StatusCode;
using Message = v1::SynthesizeLiveRequest;
using Reply = v1::SynthesizeLiveResponse;

constexpr int kRate = 15, kValues = 45;  // of a frame
constexpr double kIdleSeconds = 7;

Message Frames(int first, int count) {
  Message message;
  *message.mutable_frames() = test::SampleLeaderFrames(first, count);
  return message;
}

Message LabelChange(float kick) {
  Message message;
  AddWeight(*message.mutable_label_change()->mutable_label_vector(), "kick", kick);
  return message;
}

auto IsInvalid(const std::string& field) {
  return StatusIs(StatusCode::kInvalidArgument, HasSubstr(field));
}

// What a caller took.
struct Taken {
  std::vector<v1::LiveNotice> notices;
  std::vector<v1::FollowerFrames> parts;
  std::vector<float> positions;
  std::optional<v1::LiveSummary> summary;
  bool end = false;
  absl::Status error;

  int frames() const { return static_cast<int>(positions.size()) / kValues; }
  // Number of frames that notices of this kind name.
  int Noticed(v1::LiveNoticeKind kind) const {
    int frames = 0;
    for (const v1::LiveNotice& notice : notices) {
      if (notice.kind() == kind) frames += static_cast<int>(notice.frames().frame_count());
    }
    return frames;
  }
};

class LiveRepliesTest : public ::testing::Test {
 protected:
  void Create(uint32_t delay = 0, uint32_t plan = 0) { Begin(Start(delay, plan)); }

  static v1::LiveStart Start(uint32_t delay = 0, uint32_t plan = 0) {
    v1::LiveStart start = test::SampleLiveStart();
    start.set_delay_frames(delay);
    start.set_plan_frames(plan);
    start.set_seed(3);
    return start;
  }

  void Begin(const v1::LiveStart& start) {
    absl::StatusOr<ValidatedLiveStart> valid =
        ValidateLiveStart(start, model_->description(), RequestLimits());
    ASSERT_THAT(valid, IsOk());
    ReplyParts parts;
    parts.model = model_;
    parts.scheduler = &scheduler_;
    parts.clock = &clock_;
    parts.deadline = deadline_;
    parts.client = "client";
    parts.idle_seconds = kIdleSeconds;
    parts.buffered_frames = buffered_frames_;
    valid->live.options.clean_up = false;
    session_ = std::make_shared<LiveReplies>(std::move(parts), *std::move(valid));
    reads_ = 0;
    record_ = {};
    ASSERT_THAT(session_->Start({[this] { ++progress_; },
                                 [this](double timeout_seconds) {
                                   EXPECT_EQ(timeout_seconds, kIdleSeconds);
                                   ++reads_;
                                   return true;
                                 }}),
                IsOk());
    const NextReply header = session_->Next(record_);
    header_ = dynamic_cast<const Reply&>(*header.message).header();
  }

  // Delivers the message that the session is reading.
  void Send(const absl::StatusOr<Message>& message) {
    ASSERT_GE(reads_, 1) << "the session reads no message";
    --reads_;
    session_->OnMessage(message);
    EXPECT_LE(reads_, 1) << "one message at a time";
  }
  void End() {
    ASSERT_GE(reads_, 1);
    --reads_;
    session_->OnEndOfMessages();
  }

  void RunAll() {
    while (scheduler_.queued_windows() > 0) scheduler_.RunNext();
  }

  Taken Take() {
    Taken taken;
    for (;;) {
      const NextReply next = session_->Next(record_);
      if (next.message == nullptr) {
        taken.end = next.end.has_value() && next.end->ok();
        taken.error = next.end.value_or(absl::OkStatus());
        return taken;
      }
      const Reply& reply = dynamic_cast<const Reply&>(*next.message);
      if (reply.has_notice()) taken.notices.push_back(reply.notice());
      if (reply.has_summary()) taken.summary = reply.summary();
      if (!reply.has_frames()) continue;
      const v1::FollowerFrames& frames = reply.frames();
      taken.positions.insert(taken.positions.end(), frames.positions().begin(),
                             frames.positions().end());
      EXPECT_EQ(frames.first_frame(), static_cast<uint32_t>(answered_));
      answered_ += static_cast<int>(frames.frame_count());
      taken.parts.push_back(frames);
    }
  }

  metrics::CallRecord Report() const {
    metrics::CallRecord record;
    session_->Report(record);
    return record;
  }

  FakeClock clock_;
  common::TimePoint deadline_ = common::TimePoint::max();
  PuppetScheduler scheduler_;
  std::shared_ptr<FakeSynthesizer> model_ =
      std::make_shared<FakeSynthesizer>(test::SamplingDescription());
  int buffered_frames_ = 240;
  std::atomic<int> reads_{0}, progress_{0};
  int answered_ = 0;
  metrics::CallRecord record_;
  v1::LiveHeader header_;
  std::shared_ptr<LiveReplies> session_;
};

TEST_F(LiveRepliesTest, EachFrameIsAnsweredInOrder) {
  Create(/*delay=*/0, /*plan=*/2);
  for (int t = 0; t < 60; ++t) {
    Send(Frames(t, 1));
    RunAll();
    const Taken taken = Take();
    ASSERT_THAT(taken.parts, SizeIs(1)) << t;
    EXPECT_THAT(taken.notices, IsEmpty());
    EXPECT_FALSE(taken.end);
    EXPECT_EQ(taken.frames(), 1);
    EXPECT_EQ(taken.parts[0].leader_frame(), static_cast<uint32_t>(t));
    EXPECT_EQ(taken.parts[0].capture_seconds(), t);
    EXPECT_EQ(taken.parts[0].plan_positions_size(), 2 * kValues);
  }
  End();
  EXPECT_TRUE(Take().end);
  const metrics::CallRecord report = Report();
  EXPECT_GT(report.totals.windows, 10);
  EXPECT_EQ(report.totals.queue_seconds, 0.25 * report.totals.windows);
  EXPECT_EQ(report.totals.compute_seconds, 0.5 * report.totals.windows);
}

TEST_F(LiveRepliesTest, OneWindowAtATimeAndProgressIsReported) {
  Create();
  for (int t = 0; t < 9; ++t) Send(Frames(t, 1));
  EXPECT_EQ(scheduler_.queued_windows(), 1);
  EXPECT_EQ(scheduler_.Oldest().priority, batching::Priority::kInteractive);
  EXPECT_EQ(scheduler_.Oldest().client, "client");
  EXPECT_EQ(Take().frames(), 0);
  const int before = progress_;
  scheduler_.RunNext();
  EXPECT_GT(progress_, before);
  EXPECT_GT(Take().frames(), 0);
}

TEST_F(LiveRepliesTest, FramesThatWaitForTheDelayAreAnsweredAtTheEnd) {
  Create(/*delay=*/3);
  Send(Frames(0, 10));
  RunAll();
  EXPECT_EQ(Take().frames(), 7);
  End();
  RunAll();
  const Taken rest = Take();
  EXPECT_EQ(answered_, 10);
  EXPECT_TRUE(rest.end);
}

TEST_F(LiveRepliesTest, MissingFramesAreInterpolated) {
  Message filled = Frames(9, 32);
  for (int t = 0; t < 2; ++t) {
    const Message before = Frames(8, 1), after = Frames(11, 1);
    const float at = static_cast<float>(t + 1) / 3;
    for (int i = 0; i < kValues; ++i) {
      const float a = before.frames().positions(i), b = after.frames().positions(i);
      filled.mutable_frames()->set_positions(t * kValues + i, a + (b - a) * at);
    }
  }
  std::vector<Taken> both;
  for (const bool gap : {false, true}) {
    Create();
    answered_ = 0;
    Send(Frames(0, 9));
    RunAll();
    Send(gap ? Frames(11, 30) : filled);
    RunAll();
    both.push_back(Take());
    EXPECT_EQ(both.back().Noticed(v1::LIVE_NOTICE_KIND_GAP_FILLED), gap ? 2 : 0);
  }
  ASSERT_EQ(both[0].frames(), 41);
  ASSERT_EQ(both[1].frames(), 41);
  for (std::size_t i = 0; i < 41 * kValues; ++i) {
    ASSERT_NEAR(both[0].positions[i], both[1].positions[i], 1e-4) << i;
  }
}

TEST_F(LiveRepliesTest, AGapBeforeTheFirstFrameHoldsIt) {
  Create();
  Send(Frames(4, 1));
  RunAll();
  const Taken taken = Take();
  EXPECT_EQ(taken.frames(), 5);
  ASSERT_FALSE(taken.notices.empty());
  EXPECT_EQ(taken.notices[0].kind(), v1::LIVE_NOTICE_KIND_GAP_FILLED);
  EXPECT_EQ(taken.notices[0].frames().first_frame(), 0);
  EXPECT_EQ(taken.notices[0].frames().frame_count(), 4);
  End();
  EXPECT_EQ(Take().summary->gap_frames(), 4);
}

TEST_F(LiveRepliesTest, TooLongAGapEndsTheSessionAfterItsFrames) {
  Create();
  Send(Frames(0, 3));
  RunAll();
  Send(Frames(3 + 2 * kRate + 1, 1));
  const Taken taken = Take();
  EXPECT_EQ(taken.frames(), 3);
  EXPECT_THAT(taken.error, IsInvalid("frames.first_frame: expected at most 33 (2 s after frame 3"));
  EXPECT_EQ(reads_, 0);
}

TEST_F(LiveRepliesTest, LateFramesAreDroppedAndAreNotTheNewest) {
  Create();
  Send(Frames(0, 10));
  clock_.Advance(std::chrono::milliseconds(500));
  Send(Frames(2, 3));
  RunAll();
  const Taken taken = Take();
  ASSERT_FALSE(taken.notices.empty());
  EXPECT_EQ(taken.notices[0].kind(), v1::LIVE_NOTICE_KIND_LATE);
  EXPECT_EQ(taken.notices[0].frames().first_frame(), 2);
  EXPECT_EQ(taken.notices[0].frames().frame_count(), 3);
  ASSERT_THAT(taken.parts, SizeIs(1));
  EXPECT_EQ(taken.parts[0].frame_count(), 10);
  EXPECT_EQ(taken.parts[0].leader_frame(), 9);
  EXPECT_EQ(taken.parts[0].capture_seconds(), 9);
  EXPECT_EQ(taken.parts[0].server_seconds(), 0.5F);
  EXPECT_EQ(record_.first_chunk_seconds, 0.5);
  End();
  EXPECT_EQ(Take().summary->late_frames(), 3);
}

TEST_F(LiveRepliesTest, SkippedEvaluationsAreTold) {
  Create();
  Send(Frames(0, 1));
  for (int t = 1; t < 16; ++t) Send(Frames(t, 1));
  RunAll();
  const Taken taken = Take();
  EXPECT_EQ(taken.frames(), 16);
  int skipped = 0;
  for (const v1::LiveNotice& notice : taken.notices) {
    EXPECT_EQ(notice.kind(), v1::LIVE_NOTICE_KIND_SKIPPED);
    skipped += static_cast<int>(notice.frames().frame_count());
    EXPECT_LE(notice.frames().first_frame() + notice.frames().frame_count(), 16);
  }
  EXPECT_GT(skipped, 0);
  End();
  EXPECT_EQ(Take().summary->skipped_frames(), skipped);
}

TEST_F(LiveRepliesTest, AFailedWindowEndsTheSession) {
  Create();
  Send(Frames(0, 1));
  RunAll();
  Send(Frames(1, 10));
  scheduler_.FailNext(absl::InternalError("of the engine"));
  const Taken taken = Take();
  EXPECT_GE(taken.frames(), 1) << "what was final before";
  EXPECT_THAT(taken.error, StatusIs(StatusCode::kInternal, HasSubstr("the model failed")));
  EXPECT_THAT(record_.cause, HasSubstr("of the engine")) << "for the log";
  EXPECT_EQ(scheduler_.queued_windows(), 0);
}

TEST_F(LiveRepliesTest, AFirstWindowThatIsNotStartedInTimeEndsTheSession) {
  Create();
  Send(Frames(0, 1));
  EXPECT_EQ(scheduler_.Oldest().deadline, clock_.Now() + std::chrono::seconds(10));
  clock_.Advance(std::chrono::seconds(10));
  scheduler_.FailNext(absl::DeadlineExceededError("the deadline passed"));
  EXPECT_THAT(Take().error, StatusIs(StatusCode::kResourceExhausted, HasSubstr("within 10 s")));
}

TEST_F(LiveRepliesTest, LaterWindowsHaveOnlyTheCallersDeadline) {
  deadline_ = clock_.Now() + std::chrono::seconds(3);
  Create();
  for (int t = 0; t < 2; ++t) {
    Send(Frames(t, 1));
    EXPECT_EQ(scheduler_.Oldest().deadline, deadline_) << "also the first: it is earlier";
    EXPECT_TRUE(scheduler_.Oldest().continues_call) << "needs no room in the queue";
    if (t == 0) RunAll();
  }
  clock_.Advance(std::chrono::seconds(3));
  scheduler_.FailNext(absl::DeadlineExceededError("the deadline passed"));
  EXPECT_THAT(Take().error, StatusIs(StatusCode::kDeadlineExceeded, "the deadline passed"));
}

TEST_F(LiveRepliesTest, NothingIsReadWhileTheReaderDoesNotTakeFrames) {
  buffered_frames_ = 20;
  Create();
  int sent = 0;
  while (reads_ > 0 && sent < 100) {
    Send(Frames(sent++, 1));
    RunAll();
  }
  EXPECT_GE(sent, 20);
  EXPECT_LE(sent, 21) << "one was being read while a window was in flight";
  EXPECT_EQ(Report().totals.peak_buffered_frames, sent);
  EXPECT_EQ(Take().frames(), sent);
  EXPECT_EQ(reads_, 1);
}

TEST_F(LiveRepliesTest, NothingIsReadWhileTwoSecondsAreUnanswered) {
  for (const int delay : {0, 5}) {
    Create(static_cast<uint32_t>(delay));
    answered_ = 0;
    int sent = 0;
    while (reads_ > 0 && sent < 100) Send(Frames(sent++, 1));
    EXPECT_EQ(sent, 2 * kRate + delay + 1);
    RunAll();
    EXPECT_EQ(reads_, 1);
    EXPECT_EQ(Take().frames(), sent - delay);
  }
}

TEST_F(LiveRepliesTest, NothingIsReadWhileManyNoticesWait) {
  Create();
  Send(Frames(0, 1));
  RunAll();
  int late = 0;
  while (reads_ > 0 && late < 100) {
    Send(Frames(0, 1));
    ++late;
  }
  EXPECT_EQ(late, 16);
  EXPECT_THAT(Take().notices, SizeIs(16));
  EXPECT_EQ(reads_, 1);
}

TEST_F(LiveRepliesTest, ACancelledSessionStartsNoMoreWindows) {
  Create();
  Send(Frames(0, 1));
  session_->Cancel();
  EXPECT_FALSE(scheduler_.RunNext()) << "the window in flight is dropped";
  Send(Frames(1, 5));
  EXPECT_EQ(scheduler_.queued_windows(), 0);
  EXPECT_EQ(Take().frames(), 0);
}

TEST_F(LiveRepliesTest, ALeaderInCentimetresEndsTheSessionWithItsFirstFrame) {
  Create();
  Message centimetres = Frames(0, 1);
  for (float& value : *centimetres.mutable_frames()->mutable_positions()) value *= 100;
  Send(centimetres);
  EXPECT_THAT(Take().error, IsInvalid("frames.positions: expected the size of a person"));
}

TEST_F(LiveRepliesTest, ALabelChangeOfAFinalFrameIsRefused) {
  Create(/*delay=*/2);
  Send(Frames(0, 10));
  Message change = LabelChange(0);
  change.mutable_label_change()->set_frame(8);
  Send(change);
  RunAll();
  EXPECT_THAT(Take().error, IsOk());
  change.mutable_label_change()->set_frame(7);
  Send(change);
  EXPECT_THAT(Take().error, IsInvalid("label_change.frame"));
}

TEST_F(LiveRepliesTest, AnnouncedLabelChangesAreBounded) {
  Create();
  const int most = RequestLimits().max_label_keyframes;
  for (int round = 0; round < 2; ++round) {  // the second replaces the first
    for (int i = 0; i < most; ++i) {
      Message change = LabelChange(0.5F);
      change.mutable_label_change()->set_frame(static_cast<uint32_t>(10 + 2 * i));
      Send(change);
    }
  }
  EXPECT_THAT(Take().error, IsOk());
  Message change = LabelChange(0.5F);
  change.mutable_label_change()->set_frame(static_cast<uint32_t>(20 + 2 * most));
  Send(change);
  EXPECT_THAT(Take().error, IsInvalid("label_change.frame"));
}

TEST_F(LiveRepliesTest, MessagesWindowsAndTheReaderRunAtTheSameTime) {
  constexpr int kFrames = 300;
  buffered_frames_ = 10;
  Create();
  std::atomic<bool> over{false};
  std::thread windows([&] {
    while (!over) {
      if (scheduler_.queued_windows() > 0) {
        scheduler_.RunNext();
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::thread messages([&] {
    for (int t = 0; t < kFrames && !over;) {
      if (reads_ > 0) {
        Send(Frames(t++, 1));
      } else {
        std::this_thread::yield();
      }
    }
    while (reads_ == 0 && !over) std::this_thread::yield();
    End();
  });
  std::thread drain([&] { session_->OnDraining(); });
  Taken last;
  do {
    last = Take();
    EXPECT_THAT(last.error, IsOk());
    std::this_thread::yield();
  } while (!last.end && last.error.ok());
  messages.join();
  drain.join();
  over = true;
  windows.join();
  EXPECT_EQ(answered_, kFrames);
}

}  // namespace
}  // namespace duet::server::service
