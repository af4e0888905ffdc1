#ifndef DUET_SERVER_SERVICE_CLIP_REPLIES_H_
#define DUET_SERVER_SERVICE_CLIP_REPLIES_H_

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "duet/v1/synthesis.pb.h"
#include "model/body/grade.h"
#include "model/engine/candidates.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/synthesizer.h"
#include "server/batching/window_scheduler.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"
#include "server/service/reply_mapping.h"
#include "server/service/reply_source.h"
#include "server/service/validator.h"

namespace duet::server::service {

// Returns the error of a window's result, or INTERNAL if an engine that violates its contract
// returned another shape than [frames, joints], or positions that are not finite.
absl::Status CheckWindow(const engine::WindowResult& result, int frames, int joints);

// What headers of clips and of live sessions have in common. `options.clean_up` is set.
template <typename Header>
void FillCommonHeader(const engine::ModelDescription& model, const ReplyMapping& mapping,
                      const engine::SynthesisOptions& options, const std::string& request_id,
                      Header& header) {
  header.set_model_name(model.name);
  header.set_model_version(static_cast<uint32_t>(model.version));
  for (const std::string& name : mapping.joint_names) header.add_joint_names(name);
  header.set_frame_rate_hz(mapping.frame_rate_hz);
  header.set_unit(mapping.unit);
  header.set_up_axis(mapping.up_axis);
  for (const std::string& name : model.classes) header.add_interaction_classes(name);
  header.set_request_id(request_id);
  header.set_seed(options.sampling.seed);
  header.set_variety(options.sampling.variety);
  header.set_candidates(static_cast<uint32_t>(engine::CandidateCount(model, options.sampling)));
  header.set_clean_up(*options.clean_up ? v1::CLEAN_UP_ON : v1::CLEAN_UP_OFF);
}

// The same for summaries.
template <typename Summary>
void FillCommonSummary(int frames, const metrics::WindowTotals& totals, Summary& summary) {
  summary.set_frame_count(static_cast<uint32_t>(frames));
  summary.set_window_count(static_cast<uint32_t>(totals.windows));
  summary.set_queue_seconds(totals.queue_seconds);
  summary.set_compute_seconds(totals.compute_seconds);
}

// What both report. `options.clean_up` is set.
void ReportCommon(const engine::ModelDescription& model, const engine::SynthesisOptions& options,
                  batching::Priority priority, const metrics::WindowTotals& totals,
                  metrics::CallRecord& record);

// What the replies of a clip or a live session depend on. Pointers outlive the call and its
// windows.
struct ReplyParts {
  std::shared_ptr<const engine::Synthesizer> model;
  batching::WindowScheduler* scheduler = nullptr;
  const common::Clock* clock = nullptr;  // of a live session
  RequestLimits limits;                  // likewise
  common::TimePoint deadline = common::TimePoint::max();
  std::string client;  // see WindowJob
  // Required. At least 1. No window of a clip is scheduled, and no message of a session read, while
  // as many finished frames wait for the reader.
  int buffered_frames = 0;
  double idle_seconds = 0;  // of a live session: the longest time between two messages
  // What decides the bits of a clip besides request and weights (SynthesisHeader).
  std::string engine, server_version;
};

// The replies of Synthesize: header, chunks and summary of one clip.
//
// Runs the clip through the scheduler, one window at a time, and buffers finished frames until the
// reader takes them. The clip pauses while its reader takes nothing, so memory is bounded by
// buffered_frames and one window. With rotations, the header follows once the first frames exist,
// because its rig has their bone lengths.
//
// Chunks hold at most request.chunk_frames frames. Model failures become INTERNAL without details;
// CallRecord::cause has the details for the log.
//
// Threads: as ReplySource. on_progress runs on the scheduler's threads, under no lock. Uses neither
//          gRPC nor abseil's synchronisation (ARCHITECTURE.md).
class ClipReplies final : public ReplySource, public std::enable_shared_from_this<ClipReplies> {
 public:
  // Requires request.clip.options.clean_up to be set.
  ClipReplies(ReplyParts parts, ValidatedRequest request);

  absl::Status Start(SourceEvents events) override;
  NextReply Next(metrics::CallRecord& record) override;
  void Cancel() override { cancelled_->store(true, std::memory_order_release); }
  void Report(metrics::CallRecord& record) const override;

 private:
  enum class Part { kHeader, kFrames, kEnd };
  enum class Ready { kNothing, kFrames, kAllTaken, kFailed };
  struct Stats {
    metrics::WindowTotals totals;
    // Set when every window has been evaluated.
    std::optional<double> unfamiliarity;  // engine::Synthesizer::Unfamiliarity
    std::optional<body::Grade> grade;     // engine::ClipSynthesis::grade
    std::vector<float> pin_distances;     // engine::ClipSynthesis::pin_distances
  };

  // Moves the next finished frames, at most chunk_frames_, to next_frames_.
  Ready Take() DUET_EXCLUDES(mutex_);
  absl::Status error() const DUET_EXCLUDES(mutex_);
  Stats stats() const DUET_EXCLUDES(mutex_);
  void FillHeader(const metrics::CallRecord& record);
  void FillChunk(metrics::CallRecord& record);
  void FillSummary(const metrics::CallRecord& record);

  bool WantsWindow() const DUET_REQUIRES(mutex_);
  absl::Status ScheduleNext(bool continues_call);
  void ScheduleIfWanted() DUET_EXCLUDES(mutex_);
  void OnWindow(const batching::WindowOutcome& outcome);
  // Measures the leader and the follower after the last window, on the scheduler's thread, so that
  // it delays only the last frames.
  void KeepMeasures() DUET_EXCLUDES(mutex_);
  void Keep(const absl::Status& status, const motion::Poses& frames,
            const batching::WindowTimings& timings) DUET_EXCLUDES(mutex_);

  const ReplyParts parts_;
  const engine::SynthesisOptions options_;
  const batching::Priority priority_;
  const ReplyMapping mapping_;
  const int chunk_frames_;
  const std::shared_ptr<std::atomic<bool>> cancelled_;
  std::function<void()> on_progress_;  // constant after Start

  // Used only by the thread that asks for replies.
  Part next_ = Part::kHeader;
  motion::Poses next_frames_;      // taken, but not sent
  std::unique_ptr<ReplyRig> rig_;  // with rotations, made from the first frames
  v1::SynthesizeResponse reply_;   // the last one returned

  // Used only by the thread that set in_flight_ or received its window. frame_count() is constant.
  engine::ClipSynthesis clip_;
  int expected_frames_ = 0;  // of the window in flight

  mutable common::Mutex mutex_;
  bool in_flight_ DUET_GUARDED_BY(mutex_) = false;
  motion::Poses ready_ DUET_GUARDED_BY(mutex_);
  int taken_ DUET_GUARDED_BY(mutex_) = 0;  // frames of ready_ already handed out
  absl::Status error_ DUET_GUARDED_BY(mutex_);
  Stats stats_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CLIP_REPLIES_H_
