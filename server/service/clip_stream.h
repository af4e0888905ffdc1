#ifndef DUET_SERVER_SERVICE_CLIP_STREAM_H_
#define DUET_SERVER_SERVICE_CLIP_STREAM_H_

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/body/grade.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/synthesizer.h"
#include "server/batching/window_scheduler.h"
#include "server/common/mutex.h"

namespace duet::server::service {

// Returns the error of a window's result, or INTERNAL if an engine that violates its contract
// returned another shape than [frames, joints], or positions that are not finite.
absl::Status CheckWindow(const engine::WindowResult& result, int frames, int joints);

struct ClipStreamOptions {
  batching::Priority priority = batching::Priority::kInteractive;
  common::TimePoint deadline = common::TimePoint::max();
  // Required. At least 1. The next window is scheduled only while fewer finished frames than this
  // wait for the reader.
  int buffered_frames = 0;
  std::string client;  // see WindowJob
};

// Statistics of one call, for its summary, metrics and log line.
struct ClipStreamStats {
  int windows = 0;
  double queue_seconds = 0;
  double compute_seconds = 0;
  int peak_buffered_frames = 0;
  // engine::Synthesizer::Unfamiliarity. Set when every window has been evaluated.
  std::optional<double> unfamiliarity;
  // engine::ClipSynthesis::grade. Set when every window has been evaluated.
  std::optional<body::Grade> grade;
  // engine::ClipSynthesis::pin_distances. Set when every window has been evaluated.
  std::vector<float> pin_distances;
};

// The next part of a follower's motion.
struct ClipPart {
  enum class Kind {
    kPending,  // nothing is ready; on_progress will be called
    kFrames,   // poses[0, n) follow the frames taken before
    kEnd,      // every frame has been taken
    kFailed    // the stream ends with `error`
  };
  Kind kind = Kind::kPending;
  motion::Poses poses;  // [n, joints], n >= 1
  absl::Status error;
};

// Runs one clip through the scheduler, one window at a time, and buffers finished frames until the
// reader takes them. The clip pauses while its reader takes nothing, so memory is bounded by
// buffered_frames and one window.
//
//   auto stream = std::make_shared<ClipStream>(model, clip, options, scheduler, on_progress);
//   absl::Status admitted = stream->Start();
//   ... on_progress: while ((part = stream->Take(30)).kind == kFrames) send(part.poses) ...
//
// Threads: safe to call concurrently. on_progress runs on the scheduler's threads, under no lock,
//          and may still run after the end was taken.
class ClipStream : public std::enable_shared_from_this<ClipStream> {
 public:
  // `scheduler` outlives every job given to it. The model lives until the last job is done.
  ClipStream(std::shared_ptr<const engine::Synthesizer> model, engine::ClipRequest request,
             const ClipStreamOptions& options, batching::WindowScheduler& scheduler,
             std::function<void()> on_progress);

  // Schedules the first window. Returns the scheduler's error if it is rejected. Call once.
  absl::Status Start();

  // Takes at most `max_frames` (at least 1) of the finished frames.
  ClipPart Take(int max_frames);

  // Stops: a window that has not started never starts, and on_progress is not called for it.
  void Cancel();

  int frame_count() const { return clip_.frame_count(); }
  ClipStreamStats stats() const;

 private:
  bool WantsWindow() const DUET_REQUIRES(mutex_);
  absl::Status ScheduleNext(bool continues_call);
  void ScheduleIfWanted();
  void OnWindow(const batching::WindowOutcome& outcome);
  // Measures the leader and the follower after the last window, on the scheduler's thread, so that
  // it delays only the last frames.
  void KeepMeasures() DUET_EXCLUDES(mutex_);
  void Keep(const absl::Status& status, const motion::Poses& frames,
            const batching::WindowTimings& timings) DUET_EXCLUDES(mutex_);

  const std::shared_ptr<const engine::Synthesizer> model_;
  const ClipStreamOptions options_;
  batching::WindowScheduler& scheduler_;
  const std::function<void()> on_progress_;
  const std::shared_ptr<std::atomic<bool>> cancelled_;

  // Used only by the thread that set in_flight_ or received its window. frame_count() is constant.
  engine::ClipSynthesis clip_;
  int expected_frames_ = 0;  // of the window in flight

  mutable common::Mutex mutex_;
  bool in_flight_ DUET_GUARDED_BY(mutex_) = false;
  motion::Poses ready_ DUET_GUARDED_BY(mutex_);
  int taken_ DUET_GUARDED_BY(mutex_) = 0;  // frames of ready_ already handed out
  absl::Status error_ DUET_GUARDED_BY(mutex_);
  ClipStreamStats stats_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CLIP_STREAM_H_
