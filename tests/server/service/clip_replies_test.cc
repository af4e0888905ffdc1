#include "server/service/clip_replies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/batching/window_queue.h"
#include "tests/server/support/puppet_scheduler.h"
#include "tests/server/support/sample_request.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::FakeDescription;
using test::FakeSynthesizer;
using test::PuppetScheduler;

constexpr int kJoints = 15;
constexpr auto kInternal = absl::StatusCode::kInternal;

// A valid request for chunks of 30 frames.
ValidatedRequest Request(int frames) {
  v1::SynthesizeRequest request = test::SampleRequest(frames);
  request.set_priority(v1::PRIORITY_BULK);
  request.set_clean_up(v1::CLEAN_UP_OFF);
  return *ValidateRequest(request, FakeDescription(), RequestLimits());
}

// What a reader took.
struct Taken {
  std::vector<float> positions;
  std::optional<v1::SynthesisSummary> summary;
  std::optional<absl::Status> end;
  int frames() const { return static_cast<int>(positions.size()) / (3 * kJoints); }
};

// Takes at most so many chunks of what is ready.
Taken Take(ClipReplies& replies, metrics::CallRecord& record, int most = 1000000) {
  Taken taken;
  for (int chunks = 0; chunks < most;) {
    const NextReply next = replies.Next(record);
    taken.end = next.end;
    if (next.message == nullptr) break;
    const auto& reply = dynamic_cast<const v1::SynthesizeResponse&>(*next.message);
    if (reply.has_summary()) taken.summary = reply.summary();
    if (!reply.has_chunk()) continue;
    ++chunks;
    EXPECT_LE(reply.chunk().frame_count(), 30);
    taken.positions.insert(taken.positions.end(), reply.chunk().positions().begin(),
                           reply.chunk().positions().end());
  }
  return taken;
}

// A clip whose windows the test evaluates, and how often it was told of progress.
class PuppetClip {
 public:
  explicit PuppetClip(
      int frames, int buffered_frames = 1000000,
      std::shared_ptr<const engine::Synthesizer> model = std::make_shared<FakeSynthesizer>()) {
    ReplyParts parts;
    parts.model = std::move(model);
    parts.scheduler = &scheduler_;
    parts.deadline = common::TimePoint(std::chrono::seconds(7));
    parts.buffered_frames = buffered_frames;
    replies_ = std::make_shared<ClipReplies>(std::move(parts), Request(frames));
    EXPECT_THAT(replies_->Start({[this] { ++progress_; }, nullptr}), IsOk());
  }
  PuppetScheduler& scheduler() { return scheduler_; }
  ClipReplies* operator->() { return replies_.get(); }
  int progress() const { return progress_; }
  void Drop() { replies_.reset(); }
  // Evaluates windows until the clip wants no more for now.
  void RunAll() {
    while (scheduler_.queued_windows() > 0) scheduler_.RunNext();
  }
  Taken Take(int most = 1000000) { return service::Take(*replies_, record_, most); }
  // What ends the clip after its first window.
  absl::Status ErrorOfFirstWindow() {
    scheduler_.RunNext();
    return Take().end.value_or(absl::OkStatus());
  }
  const std::string& cause() const { return record_.cause; }
  metrics::CallRecord Report() const {
    metrics::CallRecord record;
    replies_->Report(record);
    return record;
  }

 private:
  PuppetScheduler scheduler_;
  std::atomic<int> progress_{0};
  metrics::CallRecord record_;
  std::shared_ptr<ClipReplies> replies_;
};

TEST(ClipRepliesTest, GivesEveryFrameAndASummary) {
  PuppetClip clip(200);
  EXPECT_FALSE(clip.Take().end.has_value()) << "the header is all there is";
  clip.RunAll();
  const Taken taken = clip.Take();
  EXPECT_EQ(taken.frames(), 200);
  ASSERT_TRUE(taken.summary.has_value());
  EXPECT_EQ(taken.summary->chunk_count(), 7u);
  EXPECT_THAT(*taken.end, IsOk());
}

// Finishes every window on a thread of its own before Submit returns.
class QuickScheduler final : public batching::WindowScheduler {
 public:
  absl::Status Submit(batching::WindowJob job) override {
    std::thread([&job] {
      const engine::SynthesisWindow* windows[] = {&job.window};
      job.done({std::move(job.model->Synthesize(windows).front()), {}});
    }).join();
    return absl::OkStatus();
  }
  absl::Status CheckRoom(batching::Priority, const std::string&) const override {
    return absl::OkStatus();
  }
  std::size_t queued_windows() const override { return 0; }
};

TEST(ClipRepliesTest, WindowMayCompleteBeforeItsSubmissionReturns) {
  QuickScheduler scheduler;
  ReplyParts parts;
  parts.model = std::make_shared<FakeSynthesizer>();
  parts.scheduler = &scheduler;
  parts.buffered_frames = 1000000;
  auto replies = std::make_shared<ClipReplies>(std::move(parts), Request(200));
  ASSERT_THAT(replies->Start({[] {}, nullptr}), IsOk());
  metrics::CallRecord record;
  EXPECT_EQ(Take(*replies, record).frames(), 200);
}

TEST(ClipRepliesTest, HasOneWindowInTheQueueAtATimeAndTellsHowManyTheClipHas) {
  PuppetClip clip(200);
  const int windows = clip.scheduler().Oldest().call_windows;
  for (int i = 0; i < windows; ++i) {
    ASSERT_EQ(clip.scheduler().queued_windows(), 1u);
    EXPECT_EQ(clip.scheduler().Oldest().call_windows, windows);
    clip.scheduler().RunNext();
  }
  EXPECT_EQ(clip.scheduler().queued_windows(), 0u);
  EXPECT_EQ(clip.Report().totals.windows, windows);
}

TEST(ClipRepliesTest, PausedClipResumesWhenItsBufferIsRead) {
  constexpr int kBuffered = 50;
  PuppetClip clip(3000, kBuffered);
  clip.RunAll();
  int held = clip.Report().totals.peak_buffered_frames;
  for (; held - 30 >= kBuffered; held -= 30) clip.Take(1);
  EXPECT_EQ(clip.scheduler().queued_windows(), 0u) << "as many as the limit are still there";
  clip.Take(1);
  EXPECT_EQ(clip.scheduler().queued_windows(), 1u) << "fewer than the limit";
}

TEST(ClipRepliesTest, FailsWhenALaterWindowIsRefused) {
  PuppetClip clip(200);
  clip.scheduler().Refuse(absl::UnavailableError("going away"));
  EXPECT_THAT(clip.ErrorOfFirstWindow(), StatusIs(absl::StatusCode::kUnavailable, ::testing::_));
  EXPECT_EQ(clip.progress(), 1);
}

// Answers with the leader, spoiled.
class SpoiledModel final : public engine::Synthesizer {
 public:
  using Spoil = void (*)(motion::Poses*);
  explicit SpoiledModel(Spoil spoil) : spoil_(spoil) {}

  const engine::ModelDescription& description() const override { return description_; }
  std::vector<engine::WindowResult> Synthesize(
      absl::Span<const engine::SynthesisWindow* const> windows) const override {
    motion::Poses follower = windows[0]->leader;
    spoil_(&follower);
    return {follower};
  }

 private:
  const Spoil spoil_;
  const engine::ModelDescription description_ = FakeDescription();
};

TEST(ClipRepliesTest, RefusesAResultOfTheWrongShapeOrNotFinite) {
  const std::pair<SpoiledModel::Spoil, const char*> cases[] = {
      {[](motion::Poses* poses) { poses->DropFront(1); }, "expected 40 frames of 15 joints"},
      {[](motion::Poses* poses) { *poses = motion::Poses(40, 14); }, "of 15 joints"},
      {[](motion::Poses* poses) { poses->at(3, 2).y = std::numeric_limits<float>::quiet_NaN(); },
       "not finite"}};
  for (const auto& [spoil, cause] : cases) {
    PuppetClip clip(40, 1, std::make_shared<SpoiledModel>(spoil));
    EXPECT_THAT(clip.ErrorOfFirstWindow(), StatusIs(kInternal, ::testing::_));
    EXPECT_THAT(clip.cause(), HasSubstr(cause));
  }
}

TEST(ClipRepliesTest, StartsNothingOnceCancelled) {
  PuppetClip clip(200);
  clip->Cancel();
  clip.Drop();  // the last window keeps what it needs
  EXPECT_FALSE(clip.scheduler().RunNext()) << "the queued window was evaluated";
  EXPECT_EQ(clip.scheduler().queued_windows(), 0u);
  EXPECT_EQ(clip.progress(), 0);
}

TEST(ClipRepliesTest, WorksWithManyReadersOnABatcher) {
  const auto model = std::make_shared<FakeSynthesizer>();
  struct Reader {
    common::Mutex mutex;
    common::CondVar changed;
    bool progress DUET_GUARDED_BY(mutex) = false;
    std::shared_ptr<ClipReplies> replies;
    std::thread thread;
    int frames = 0;
  };
  std::vector<Reader> readers(6);
  // Ends before the readers that it tells of progress.
  const auto batcher = batching::MakeBatcher({3, 64, {4}}, common::Clock::Real());
  for (Reader& reader : readers) {
    ReplyParts parts;
    parts.model = model;
    parts.scheduler = batcher.get();
    parts.buffered_frames = 40;
    reader.replies = std::make_shared<ClipReplies>(std::move(parts), Request(500));
    const auto on_progress = [&reader] {
      common::MutexLock lock(reader.mutex);
      reader.progress = true;
      reader.changed.NotifyAll();
    };
    ASSERT_THAT(reader.replies->Start({on_progress, nullptr}), IsOk());
    reader.thread = std::thread([&reader] {
      metrics::CallRecord record;
      for (Taken taken; !taken.end.has_value();) {
        taken = Take(*reader.replies, record);
        reader.frames += taken.frames();
        common::MutexLock lock(reader.mutex);
        while (!reader.progress && !taken.end.has_value()) reader.changed.Wait(reader.mutex);
        reader.progress = false;
      }
    });
  }
  for (Reader& reader : readers) reader.thread.join();
  for (const Reader& reader : readers) EXPECT_EQ(reader.frames, 500);
}

}  // namespace
}  // namespace duet::server::service
