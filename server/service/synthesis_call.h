#ifndef DUET_SERVER_SERVICE_SYNTHESIS_CALL_H_
#define DUET_SERVER_SERVICE_SYNTHESIS_CALL_H_

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "duet/v1/synthesis.pb.h"
#include "model/engine/synthesizer.h"
#include "server/batching/window_scheduler.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"
#include "server/service/call_scope.h"
#include "server/service/clip_stream.h"
#include "server/service/share_pool.h"
#include "server/service/validator.h"

namespace duet::server::service {

// Where a call's replies go: a gRPC reactor, or a test.
class ReplyWriter {
 public:
  virtual ~ReplyWriter() = default;
  // Begins to write; SynthesisCall::OnWritten follows, never within Write. `reply` lives till then.
  virtual void Write(const v1::SynthesizeResponse& reply) = 0;
  // Ends the call: reports it through its scope, then tells the caller. Nothing is called on the
  // writer afterwards.
  virtual void Finish(CallScope& scope, const absl::Status& status) = 0;
  // Gives up the write under way, so that OnWritten follows soon. The caller gets the code and the
  // message of `reason`, without details: trailers cannot overtake a message.
  virtual void BreakOff(const absl::Status& reason) = 0;
};

// One admitted Synthesize call: pulls finished frames from its clip as fast as its reader takes
// them, and writes header, chunks and summary, one at a time.
//
// Only the thread that moves the call from idle to writing or to finished uses the writer, so that
// the writer may be destroyed once it was told to finish, even while a worker runs a window.
//
// Threads: safe to call concurrently.
class SynthesisCall : public std::enable_shared_from_this<SynthesisCall> {
 public:
  // What a call is made of.
  struct Parts {
    std::shared_ptr<const engine::Synthesizer> model;
    ValidatedRequest request;
    ShareLease place;
    ShareLease held_bytes;  // of the request
    std::unique_ptr<CallScope> scope;
    common::TimePoint deadline = common::TimePoint::max();
    int buffered_frames = 0;  // see ClipStreamOptions
    std::string client;       // see CallIdentity
    // How long one message of the answer may wait for its reader.
    double write_timeout_seconds = std::numeric_limits<double>::infinity();
    const common::Clock* clock = &common::Clock::Real();
  };

  // `scheduler` outlives the call's windows, `writer` lives until it was told to finish.
  static std::shared_ptr<SynthesisCall> Create(Parts parts, batching::WindowScheduler& scheduler,
                                               ReplyWriter& writer);

  // Schedules the first window. Once the scheduler has accepted it, the header is written; its
  // refusal finishes the call before any header. Call once.
  void Start();

  // The writer's answer to Write.
  void OnWritten(bool ok);

  // Ends the call early: a window that has not started never will. The first reason counts.
  void Abort(const absl::Status& reason);

  // Ends a call whose deadline has passed, or whose reader takes nothing. Of the latter the write
  // under way is broken off.
  void CheckTime(common::TimePoint now);

  // As LiveCall has them.
  std::optional<common::TimePoint> waiting_since() const;
  std::optional<std::size_t> GiveUpReader(common::TimePoint now, double seconds);

 private:
  enum class State { kIdle, kWriting, kFinished };
  enum class Next { kHeader, kFrames, kEnd };

  SynthesisCall(Parts parts, const engine::SynthesisOptions& options, ReplyWriter& writer);

  void Advance();
  // Sets end_ where the call has taken too long; true when the write under way is to be broken off.
  bool EndLate(common::TimePoint now) DUET_REQUIRES(mutex_);
  // Ends the call with `reason` although a write is under way. breaking_off_ is set.
  void BreakOff(const absl::Status& reason) DUET_EXCLUDES(mutex_);
  // Prepares the next reply, if any: true when reply_ is to be written. May set end_ instead.
  bool PrepareReply() DUET_REQUIRES(mutex_);
  bool PrepareFrames() DUET_REQUIRES(mutex_);
  void PrepareHeader() DUET_REQUIRES(mutex_);
  void PrepareChunk(const ClipPart& part) DUET_REQUIRES(mutex_);
  void PrepareSummary() DUET_REQUIRES(mutex_);
  void Finish(const absl::Status& status);

  const std::shared_ptr<const engine::Synthesizer> model_;
  const ReplyMapping reply_mapping_;
  const int chunk_frames_;
  const common::TimePoint deadline_;
  const double write_timeout_seconds_;
  const common::Clock& clock_;
  ReplyWriter& writer_;
  std::shared_ptr<ClipStream> stream_;

  mutable common::Mutex mutex_;
  State state_ DUET_GUARDED_BY(mutex_) = State::kIdle;
  Next next_ DUET_GUARDED_BY(mutex_) = Next::kHeader;
  std::optional<absl::Status> end_ DUET_GUARDED_BY(mutex_);  // how the call is to finish
  v1::SynthesizeResponse reply_;                             // owned by the writer while kWriting
  common::TimePoint write_began_ DUET_GUARDED_BY(mutex_);
  // While it is, the call is not finished: the writer must stay.
  bool breaking_off_ DUET_GUARDED_BY(mutex_) = false;
  bool given_up_ DUET_GUARDED_BY(mutex_) = false;  // GiveUpReader has ended the call
  ShareLease place_ DUET_GUARDED_BY(mutex_);
  ShareLease held_bytes_ DUET_GUARDED_BY(mutex_);
  std::unique_ptr<CallScope> scope_ DUET_GUARDED_BY(mutex_);  // null once finished
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_SYNTHESIS_CALL_H_
