#ifndef DUET_SERVER_SERVICE_STREAMING_CALL_H_
#define DUET_SERVER_SERVICE_STREAMING_CALL_H_

#include <google/protobuf/message.h>

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include "absl/status/status.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"
#include "server/metrics/call_record.h"
#include "server/service/call_pipeline.h"
#include "server/service/share_pool.h"

namespace duet::server::service {

// Where the replies of a call go: a gRPC reactor, or a test.
class ReplyWriter {
 public:
  virtual ~ReplyWriter() = default;
  // Begins to write. StreamingCall::OnWritten follows, never within Write. `reply` lives until
  // then.
  virtual void Write(const google::protobuf::Message& reply) = 0;
  // Ends the call: reports it through its scope, then sends the status to the caller. Nothing is
  // called on the writer afterwards.
  virtual void Finish(CallScope& scope, const absl::Status& status) = 0;
  // Aborts the write in progress, so that OnWritten follows soon. The caller receives the code and
  // the message of `reason` without details, because trailers cannot overtake a message.
  virtual void BreakOff(const absl::Status& reason) = 0;
};

// What a source has for its call now. If neither field is set, nothing is ready: on_progress will
// be called.
struct NextReply {
  // The next message of the stream. Valid until the next call of ReplySource::Next.
  const google::protobuf::Message* message = nullptr;
  // Set after the last message: OK, or why the stream ends early.
  std::optional<absl::Status> end;
};

// The replies of one streaming call, in order. A StreamingCall owns it and writes them.
//
// Threads: the call serialises Start, Next and Report. Cancel may be called concurrently with them.
class ReplySource {
 public:
  virtual ~ReplySource() = default;

  // Begins to work. If it fails, the call ends with this status before any reply. `on_progress`
  // runs whenever Next may have become ready; it may run after the source was destroyed, and never
  // within a method of the source. Called once, before Next.
  virtual absl::Status Start(std::function<void()> on_progress) = 0;

  // Returns the next reply. Adds what it contains to `scope.record()`. Not called again after
  // NextReply::end. Must not block.
  virtual NextReply Next(CallScope& scope) = 0;

  // Stops work that has not started. No reply is taken afterwards.
  virtual void Cancel() = 0;

  // Adds what is known once the call is over: model, options, time spent. Called once, last.
  virtual void Report(metrics::CallRecord& record) const = 0;
};

// One admitted call of a method that streams its replies: takes them from a ReplySource as fast as
// the caller reads them, and writes them one at a time. Ends the call when the source ends, at its
// deadline, when its reader stalls, or when it is aborted.
//
// Only the thread that changes the state from idle to writing or to finished uses the writer, so
// the writer may be destroyed after Finish, even while a worker runs a window.
//
// Threads: safe to call concurrently.
class StreamingCall : public std::enable_shared_from_this<StreamingCall> {
 public:
  // What a call holds until it ends, and its limits.
  struct Parts {
    ShareLease place;
    ShareLease held_bytes;  // of the request
    std::unique_ptr<CallScope> scope;
    common::TimePoint deadline = common::TimePoint::max();
    // Maximum time that one reply may wait for its reader.
    double write_timeout_seconds = std::numeric_limits<double>::infinity();
    const common::Clock* clock = &common::Clock::Real();
  };

  // `writer` lives until Finish was called on it.
  static std::shared_ptr<StreamingCall> Create(Parts parts, std::unique_ptr<ReplySource> source,
                                               ReplyWriter& writer);

  // Starts the source, then writes its first reply. If the source does not start, ends the call
  // before any reply. Call once, before everything else.
  void Start();

  // The write that ReplyWriter::Write began is over. `ok`: the caller took the reply.
  void OnWritten(bool ok);

  // Ends the call early: work that has not started never starts. The first reason counts.
  void Abort(const absl::Status& reason);

  // Ends a call whose deadline has passed, or whose reader has stalled. Breaks off the write of a
  // stalled reader.
  void CheckTime(common::TimePoint now);

  // See ActiveCall.
  std::optional<common::TimePoint> waiting_since() const;
  std::optional<std::size_t> GiveUpReader(common::TimePoint now, double seconds);

 private:
  enum class State { kIdle, kWriting, kFinished };

  StreamingCall(Parts parts, std::unique_ptr<ReplySource> source, ReplyWriter& writer);

  void Advance();
  // Sets end_ if the call has taken too long. Returns true if the write in progress is to be broken
  // off.
  bool EndLate(common::TimePoint now) DUET_REQUIRES(mutex_);
  // Ends the call with `reason` although a write is in progress. Requires breaking_off_ to be set.
  void BreakOff(const absl::Status& reason) DUET_EXCLUDES(mutex_);
  void Finish(const absl::Status& status);

  const common::TimePoint deadline_;
  const double write_timeout_seconds_;
  const common::Clock& clock_;
  ReplyWriter& writer_;
  const std::unique_ptr<ReplySource> source_;

  mutable common::Mutex mutex_;
  State state_ DUET_GUARDED_BY(mutex_) = State::kIdle;
  std::optional<absl::Status> end_ DUET_GUARDED_BY(mutex_);  // how the call is to finish
  common::TimePoint write_began_ DUET_GUARDED_BY(mutex_);
  // While it is set, the call does not finish: the writer must stay.
  bool breaking_off_ DUET_GUARDED_BY(mutex_) = false;
  bool given_up_ DUET_GUARDED_BY(mutex_) = false;  // GiveUpReader has ended the call
  ShareLease place_ DUET_GUARDED_BY(mutex_);
  ShareLease held_bytes_ DUET_GUARDED_BY(mutex_);
  std::unique_ptr<CallScope> scope_ DUET_GUARDED_BY(mutex_);  // null once finished
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_STREAMING_CALL_H_
