#ifndef DUET_SERVER_SERVICE_REPLY_SOURCE_H_
#define DUET_SERVER_SERVICE_REPLY_SOURCE_H_

#include <google/protobuf/message.h>

#include <functional>
#include <optional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/live.pb.h"
#include "server/metrics/call_record.h"

namespace duet::server::service {

// What a source has for its call now. If neither field is set, nothing is ready: on_progress will
// be called.
struct NextReply {
  // The next message of the stream. Valid until the next call of ReplySource::Next.
  const google::protobuf::Message* message = nullptr;
  // Set after the last message: OK, or why the stream ends early.
  std::optional<absl::Status> end;
};

// How a source reaches its call, from any thread, also after the call has ended.
struct SourceEvents {
  std::function<void()> on_progress;                      // Next may have become ready
  std::function<bool(double timeout_seconds)> read_next;  // see Call::ReadNext
};

// Makes the replies of one streaming call, in order, and takes its further messages: the seam
// between a call and the scheduler. A window in progress may keep the source after its call.
//
// Threads: the call serialises Start, Next and Report, and it serialises OnMessage and
// OnEndOfMessages. Anything else may run concurrently. No method may block.
class ReplySource {
 public:
  virtual ~ReplySource() = default;

  // Begins to work. If it fails, the call ends with this status before any reply. Called once,
  // before everything else.
  virtual absl::Status Start(SourceEvents events) = 0;

  // Returns the next reply. Adds what it contains to `record`. Not called again after
  // NextReply::end.
  virtual NextReply Next(metrics::CallRecord& record) = 0;

  // Stops work that has not started. No reply is taken afterwards.
  virtual void Cancel() = 0;

  // Adds what is known once the call is over: model, options, time spent. Called once, last.
  virtual void Report(metrics::CallRecord& record) const = 0;

  // The rest is for live sessions.

  // A message has arrived, or bytes that are none. The next one is read only after read_next, so a
  // call never holds more than one message that was not handled.
  virtual void OnMessage(const absl::StatusOr<v1::SynthesizeLiveRequest>&) {}
  // The caller sends no more messages. Called at most once.
  virtual void OnEndOfMessages() {}
  // The server has begun to drain; the call goes on. Called at most once.
  virtual void OnDraining() {}
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_REPLY_SOURCE_H_
