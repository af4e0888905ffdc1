#include "server/service/clip_stream.h"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "server/batching/batcher.h"
#include "tests/server/support/puppet_scheduler.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"

namespace duet::server::service {
namespace {

using test::FakeAnswer;
using test::FakeDescription;
using test::FakeSynthesizer;
using test::PuppetScheduler;
using test::SwayingMotion;

using Kind = ClipPart::Kind;

constexpr int kJoints = 15;
constexpr auto kInternal = absl::StatusCode::kInternal;

engine::ClipRequest Request(int frames) {
  return {SwayingMotion(frames, 15), 15, engine::LabelTrack(std::vector<float>{1, 0, 0, 0, 0, 0}),
          std::nullopt, std::nullopt};
}

// A stream whose windows the test evaluates, and how often it was told of progress.
class PuppetStream {
 public:
  explicit PuppetStream(
      int frames, int buffered_frames = 1000000,
      std::shared_ptr<FakeSynthesizer> model = std::make_shared<FakeSynthesizer>())
      : stream_(std::make_shared<ClipStream>(std::move(model), Request(frames),
                                             Options(buffered_frames), scheduler_,
                                             [this] { ++progress_; })) {}
  PuppetScheduler& scheduler() { return scheduler_; }
  ClipStream* operator->() { return stream_.get(); }
  int progress() const { return progress_; }
  void Drop() { stream_.reset(); }
  // Evaluates windows until the stream wants no more for now.
  void RunAll() {
    while (scheduler_.queued_windows() > 0) scheduler_.RunNext();
  }

 private:
  static ClipStreamOptions Options(int buffered_frames) {
    ClipStreamOptions options;
    options.priority = batching::Priority::kBulk;
    options.deadline = common::TimePoint(std::chrono::seconds(7));
    options.buffered_frames = buffered_frames;
    return options;
  }
  PuppetScheduler scheduler_;
  std::atomic<int> progress_{0};
  std::shared_ptr<ClipStream> stream_;
};

// Takes parts until there is none; returns the frames and what ended them.
std::pair<std::vector<motion::Vec3>, Kind> TakeAll(PuppetStream& stream, int max_frames) {
  std::vector<motion::Vec3> frames;
  while (true) {
    const ClipPart part = stream->Take(max_frames);
    if (part.kind != Kind::kFrames) return {frames, part.kind};
    EXPECT_LE(part.poses.frame_count(), max_frames);
    frames.insert(frames.end(), part.poses.all().begin(), part.poses.all().end());
  }
}

TEST(ClipStreamTest, GivesEveryFrameInOrder) {
  PuppetStream stream(200);
  ASSERT_THAT(stream->Start(), IsOk());
  stream.RunAll();
  const auto [frames, end] = TakeAll(stream, 30);
  EXPECT_EQ(end, Kind::kEnd);
  const motion::Poses leader = SwayingMotion(200, 15);
  ASSERT_EQ(frames.size(), leader.all().size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const motion::Vec3 expected = FakeAnswer(leader.all()[i], std::vector<float>{1, 0, 0, 0, 0, 0});
    ASSERT_LT(Distance(frames[i], expected), 1e-4F) << "position " << i;
  }
}

TEST(ClipStreamTest, ClipOfOneWindowEndsWithItsWindow) {
  PuppetStream stream(40);
  ASSERT_THAT(stream->Start(), IsOk());
  EXPECT_EQ(stream->Take(40).kind, Kind::kPending);
  stream.scheduler().RunNext();
  EXPECT_EQ(stream->Take(40).kind, Kind::kFrames);
  EXPECT_EQ(stream->Take(40).kind, Kind::kEnd);
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

TEST(ClipStreamTest, WindowMayCompleteBeforeItsSubmissionReturns) {
  QuickScheduler scheduler;
  ClipStreamOptions options;
  options.buffered_frames = 1000000;
  auto stream = std::make_shared<ClipStream>(std::make_shared<FakeSynthesizer>(), Request(200),
                                             options, scheduler, [] {});
  ASSERT_THAT(stream->Start(), IsOk());
  const ClipPart all = stream->Take(200);
  EXPECT_EQ(all.poses.frame_count(), 200);
  EXPECT_EQ(stream->Take(200).kind, Kind::kEnd);
}

TEST(ClipStreamTest, HasOneWindowInTheQueueAtATime) {
  PuppetStream stream(2000);
  ASSERT_THAT(stream->Start(), IsOk());
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(stream.scheduler().queued_windows(), 1u);
    stream.scheduler().RunNext();
  }
}

TEST(ClipStreamTest, TellsHowManyWindowsTheClipHas) {
  PuppetStream stream(200);
  ASSERT_THAT(stream->Start(), IsOk());
  const int windows = stream.scheduler().NextCallWindows();
  stream.scheduler().RunNext();
  EXPECT_EQ(stream.scheduler().NextCallWindows(), windows);
  stream.RunAll();
  EXPECT_EQ(stream->stats().windows, windows);
}

TEST(ClipStreamTest, PausedClipResumesWhenItsBufferIsRead) {
  constexpr int kBuffered = 50;
  PuppetStream stream(3000, kBuffered);
  ASSERT_THAT(stream->Start(), IsOk());
  stream.RunAll();
  const int held = stream->stats().peak_buffered_frames;
  stream->Take(held - kBuffered);
  EXPECT_EQ(stream.scheduler().queued_windows(), 0u) << "as many as the limit are still there";
  stream->Take(1);
  EXPECT_EQ(stream.scheduler().queued_windows(), 1u) << "one fewer than the limit";
}

TEST(ClipStreamTest, HoldsLittleHoweverLongTheClip) {
  constexpr int kBuffered = 50;
  PuppetStream stream(9000, kBuffered);
  ASSERT_THAT(stream->Start(), IsOk());
  std::size_t frames = 0;
  Kind end = Kind::kPending;
  while (end == Kind::kPending) {
    stream.RunAll();
    const auto [taken, kind] = TakeAll(stream, 30);
    frames += taken.size() / kJoints;
    end = kind;
  }
  EXPECT_EQ(end, Kind::kEnd);
  EXPECT_EQ(frames, 9000u);
  EXPECT_LT(stream->stats().peak_buffered_frames, kBuffered + FakeDescription().window_frames);
}

TEST(ClipStreamTest, FailsWhenALaterWindowIsRefused) {
  PuppetStream stream(200, 1000000);
  ASSERT_THAT(stream->Start(), IsOk());
  stream.scheduler().Refuse(absl::UnavailableError("going away"));
  stream.scheduler().RunNext();
  EXPECT_EQ(stream.progress(), 1);
  const ClipPart part = stream->Take(30);
  EXPECT_EQ(part.kind, Kind::kFailed);
  EXPECT_THAT(part.error, StatusIs(absl::StatusCode::kUnavailable, "going away"));
}

TEST(ClipStreamTest, FailsWhenAWindowFails) {
  auto model = std::make_shared<FakeSynthesizer>();
  model->window_status = [](const engine::SynthesisWindow&) {
    return absl::InternalError("broken");
  };
  PuppetStream stream(200, 1000000, model);
  ASSERT_THAT(stream->Start(), IsOk());
  stream.scheduler().RunNext();
  const ClipPart part = stream->Take(30);
  EXPECT_EQ(part.kind, Kind::kFailed);
  EXPECT_THAT(part.error, StatusIs(kInternal, "broken"));
  EXPECT_EQ(stream.scheduler().queued_windows(), 0u) << "no further window of a failed clip";
}

TEST(ClipStreamTest, RefusesAResultThatIsNotFinite) {
  auto model = std::make_shared<FakeSynthesizer>();
  model->answer = [](motion::Vec3, absl::Span<const float>) {
    return motion::Vec3{0, std::numeric_limits<float>::quiet_NaN(), 0};
  };
  PuppetStream stream(200, 1000000, model);
  ASSERT_THAT(stream->Start(), IsOk());
  stream.scheduler().RunNext();
  EXPECT_THAT(stream->Take(30).error, StatusIs(kInternal, HasSubstr("not finite")));
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

// What becomes of a clip of 40 frames whose model answers like that.
absl::Status ErrorOf(SpoiledModel::Spoil spoil) {
  PuppetScheduler scheduler;
  ClipStreamOptions options;
  options.buffered_frames = 1;
  auto stream = std::make_shared<ClipStream>(std::make_shared<SpoiledModel>(spoil), Request(40),
                                             options, scheduler, [] {});
  EXPECT_THAT(stream->Start(), IsOk());
  scheduler.RunNext();
  return stream->Take(30).error;
}

TEST(ClipStreamTest, RefusesAResultOfTheWrongShape) {
  const auto of_wrong_shape = StatusIs(kInternal, HasSubstr("expected 40 frames of 15 joints"));
  EXPECT_THAT(ErrorOf([](motion::Poses* poses) { poses->DropFront(1); }), of_wrong_shape);
  EXPECT_THAT(ErrorOf([](motion::Poses* poses) { *poses = motion::Poses(40, 14); }),
              of_wrong_shape);
  EXPECT_THAT(ErrorOf([](motion::Poses* poses) { poses->Append({{1, 2, 3}}); }), of_wrong_shape);
}

TEST(ClipStreamTest, StartsNothingOnceCancelled) {
  PuppetStream stream(200);
  ASSERT_THAT(stream->Start(), IsOk());
  stream->Cancel();
  EXPECT_FALSE(stream.scheduler().RunNext()) << "the queued window was evaluated";
  EXPECT_EQ(stream.scheduler().queued_windows(), 0u);
  EXPECT_EQ(stream.progress(), 0);
}

TEST(ClipStreamTest, LivesUntilItsLastWindowIsDone) {
  PuppetStream stream(200);
  ASSERT_THAT(stream->Start(), IsOk());
  stream->Cancel();
  stream.Drop();
  EXPECT_FALSE(stream.scheduler().RunNext());
}

TEST(ClipStreamTest, WorksWithManyReadersOnABatcher) {
  const auto model = std::make_shared<FakeSynthesizer>();
  struct Reader {
    common::Mutex mutex;
    common::CondVar changed;
    bool progress DUET_GUARDED_BY(mutex) = false;
    std::shared_ptr<ClipStream> stream;
    std::thread thread;
    int frames = 0;
  };
  std::vector<Reader> readers(6);
  // Ends before the readers that it tells of progress.
  const auto batcher = batching::MakeBatcher({3, 64, {4}}, common::Clock::Real());
  for (Reader& reader : readers) {
    ClipStreamOptions options;
    options.buffered_frames = 40;
    reader.stream = std::make_shared<ClipStream>(model, Request(500), options, *batcher, [&reader] {
      common::MutexLock lock(reader.mutex);
      reader.progress = true;
      reader.changed.NotifyAll();
    });
    ASSERT_THAT(reader.stream->Start(), IsOk());
    reader.thread = std::thread([&reader] {
      for (ClipPart part; part.kind != Kind::kEnd; part = reader.stream->Take(7)) {
        reader.frames += part.poses.frame_count();
        if (part.kind != Kind::kPending) continue;
        common::MutexLock lock(reader.mutex);
        while (!reader.progress) reader.changed.Wait(reader.mutex);
        reader.progress = false;
      }
    });
  }
  for (Reader& reader : readers) reader.thread.join();
  for (const Reader& reader : readers) EXPECT_EQ(reader.frames, 500);
}

}  // namespace
}  // namespace duet::server::service
