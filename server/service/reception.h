#ifndef DUET_SERVER_SERVICE_RECEPTION_H_
#define DUET_SERVER_SERVICE_RECEPTION_H_

#include <grpcpp/support/byte_buffer.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"
#include "server/service/active_calls.h"
#include "server/service/admission.h"
#include "server/service/call_pipeline.h"
#include "server/service/share_pool.h"
#include "server/service/streaming_call.h"

namespace duet::server::service {

// Time limits for the first message of a call.
struct ReceptionLimits {
  // A message that takes longer needs permission to arrive slowly (Admission), because the part
  // that has arrived occupies memory.
  double slow_seconds = 0.1;
  double timeout_seconds = 30;
};

// Reads the messages of a call: a gRPC reactor, or a test.
class MessageReader {
 public:
  virtual ~MessageReader() = default;
  // Begins to read one message. Reception::HandOn or Reception::EndOfMessages follows, never within
  // Read. Must neither block nor call the reception.
  virtual void Read() = 0;
};

// Receives the messages that follow the first one of a call.
//
// Threads: one call at a time, under no lock; OnDraining and OwesAnswers may run beside another.
// Must not block.
class MessageSink {
 public:
  virtual ~MessageSink() = default;
  // A message has arrived. The next one is read only after Reception::ReadNext, so a call never
  // holds more than one message that was not handled.
  virtual void OnMessage(grpc::ByteBuffer bytes) = 0;
  // The caller sends no more messages. Called at most once.
  virtual void OnEndOfMessages() = 0;
  // The server has begun to drain; the call goes on. Called at most once.
  virtual void OnDraining() = 0;
  // Returns false while the caller has everything that follows from its messages so far.
  virtual bool OwesAnswers() const = 0;
};

// One call from its headers to its status. Waits for the first message and passes the call on; then
// passes on further messages, for methods that take several. The first event that ends the call (a
// refusal, cancellation, a time limit, shutdown) determines its status; later events are ignored.
//
//   waiting for the message -> handling it -> refused, answered, or
//                                             going on: GoOn, then ReadNext for further messages
//
// Only the thread that ends the call uses the writer, so the writer may be destroyed after Finish.
//
// Threads: safe to call concurrently.
class Reception final : public ActiveCall {
 public:
  struct Parts {
    ReplyWriter* writer = nullptr;    // lives until Finish was called on it
    MessageReader* reader = nullptr;  // lives until Close; null if the method takes one message
    Admission* admission = nullptr;
    const common::Clock* clock = nullptr;
    ReceptionLimits limits;
    std::unique_ptr<CallScope> scope;
    std::string client;
    ShareLease place;  // empty for a method whose calls are not limited in number
  };
  explicit Reception(Parts parts);

  // The first message has arrived. If it returns true, the caller handles it and ends with Refuse,
  // Answer or GoOn. If it returns false, the call has ended.
  bool Received();
  // The first message will not arrive.
  void Lost(bool cancelled);

  // Why the call is to end, if that happened while its message is handled. The thread that handles
  // the message can stop and refuse the call with this status.
  std::optional<absl::Status> ended_meanwhile() const;
  // Ends the call with an error. Everything it holds is released first.
  void Refuse(const absl::Status& reason);
  // Ends the call successfully. The caller closes the returned scope.
  std::unique_ptr<CallScope> Answer();
  // Takes frames from the caller's share, each once for each candidate. Returns RESOURCE_EXHAUSTED
  // if too few are left.
  absl::Status HoldFrames(std::int64_t frames) { return parts_.scope->HoldFrames(frames); }
  // Moves scope and place to a call that goes on.
  std::unique_ptr<CallScope> TakeScope();
  ShareLease TakePlace();
  // Starts the call, which from now on receives Abort and CheckTime. `further` receives the
  // messages after the first one; null if the method takes one message.
  void GoOn(std::shared_ptr<StreamingCall> call, std::shared_ptr<MessageSink> further = nullptr);

  // Reads the next message for the sink given to GoOn. If none arrives within `timeout_seconds`,
  // aborts the call with DEADLINE_EXCEEDED. Returns false, and reads nothing, if the call has ended
  // or takes no further message, or if a message is being read already.
  bool ReadNext(double timeout_seconds);
  // A further message has arrived. Passes it to the sink, or drops it if the call has ended.
  void HandOn(grpc::ByteBuffer bytes);
  // No further message will arrive.
  void EndOfMessages();
  // The call ends: the reader is not used any more. Called before the status is sent.
  void Close();

  const std::string& client() const override { return parts_.client; }

  // Notifies the sink given to GoOn, now or as soon as there is one.
  void Drain() override;
  void Abort(const absl::Status& reason) override;
  void CheckTime(common::TimePoint now) override;
  std::optional<common::TimePoint> waiting_since() const override;
  std::optional<std::size_t> GiveUpReader(common::TimePoint now, double seconds) override;
  std::optional<common::TimePoint> idle_since() const override;
  bool GiveUpIdle(common::TimePoint now, double seconds) override;

 private:
  enum class State { kReceiving, kHandling, kAnswering, kEnded };

  // A further message that is being read.
  struct Reading {
    common::TimePoint begin;
    double timeout_seconds = 0;
  };

  // The call that is being answered; null before GoOn.
  std::shared_ptr<StreamingCall> call() const;
  // If the state is `state`, ends the call with `reason` and returns true.
  bool EndFrom(State state, const absl::Status& reason);
  // Gets permission to arrive slowly, if the first message needs it by now.
  absl::Status CheckArrival(double waited) DUET_REQUIRES(mutex_);
  // The reading ends. Returns the sink to notify; null if there is none or the call has ended.
  std::shared_ptr<MessageSink> FinishReading();

  mutable common::Mutex mutex_;
  State state_ DUET_GUARDED_BY(mutex_) = State::kReceiving;
  Parts parts_;  // scope and place are owned by the thread that last changed state_
  const common::TimePoint begin_;
  ShareLease slow_ DUET_GUARDED_BY(mutex_);  // permission to arrive slowly, if one was needed
  std::shared_ptr<StreamingCall> call_ DUET_GUARDED_BY(mutex_);
  std::shared_ptr<MessageSink> further_ DUET_GUARDED_BY(mutex_);  // null after the last message
  bool draining_ DUET_GUARDED_BY(mutex_) = false;
  std::optional<Reading> reading_ DUET_GUARDED_BY(mutex_);
  bool given_up_ DUET_GUARDED_BY(mutex_) = false;            // GiveUpIdle has ended the call
  std::optional<absl::Status> end_ DUET_GUARDED_BY(mutex_);  // set while the message is handled
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_RECEPTION_H_
