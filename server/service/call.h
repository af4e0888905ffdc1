#ifndef DUET_SERVER_SERVICE_CALL_H_
#define DUET_SERVER_SERVICE_CALL_H_

#include <google/protobuf/message.h>
#include <grpcpp/impl/service_type.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "server/common/clock.h"
#include "server/common/mutex.h"
#include "server/metrics/call_record.h"
#include "server/service/admission.h"
#include "server/service/call_pipeline.h"
#include "server/service/reply_source.h"
#include "server/service/share_pool.h"

namespace duet::server::service {

// Time limits for the first message of a call.
struct ReceptionLimits {
  // A message that takes longer needs permission to arrive slowly (Admission), because the part
  // that has arrived occupies memory.
  double slow_seconds = 0.1;
  double timeout_seconds = 30;
};

// Where a call's messages come from and where its replies go: a gRPC reactor, or a test.
class Transport {
 public:
  virtual ~Transport() = default;
  // Begins to read a message after the first one. Call::OnMessage or Call::OnEndOfMessages follows,
  // never within Read. Must neither block nor call the call.
  virtual void Read() = 0;
  // Begins to write. Call::OnWritten follows, never within Write. `reply` lives until then.
  virtual void Write(const google::protobuf::Message& reply) = 0;
  // Ends the call: reports it through its scope, then sends the status to the caller. Nothing is
  // called on the transport afterwards.
  virtual void Finish(CallScope& scope, const absl::Status& status) = 0;
  // Aborts the write in progress, so that OnWritten follows soon. The caller receives the code and
  // the message of `reason` without details, because trailers cannot overtake a message.
  virtual void BreakOff(const absl::Status& reason) = 0;
};

// One call from its headers to its status. Waits for the first message, has it handled, and then
// writes the replies of a source as fast as the caller reads them, one at a time. The first event
// that ends the call determines its status: a refusal, the end of the source, cancellation, a time
// limit, shutdown. Later events are ignored.
//
//   waiting for the message -> handling it -> refused (Refuse), or
//                                             streaming (Run) until the source ends
//
// Only the thread that changes the state uses scope and transport, so the transport may be
// destroyed after Finish, even while a worker runs a window.
//
// Threads: safe to call concurrently.
class Call final : public std::enable_shared_from_this<Call> {
 public:
  struct Parts {
    Transport* transport = nullptr;  // lives until Finish was called on it
    Admission* admission = nullptr;
    const common::Clock* clock = nullptr;
    ReceptionLimits limits;
    std::unique_ptr<CallScope> scope;
    std::string client;
    ShareLease place;  // empty for a method whose calls are not limited in number
  };
  // What a call needs to stream its replies.
  struct Stream {
    std::shared_ptr<ReplySource> source;
    ShareLease held_bytes;  // of the request, until the call ends
    common::TimePoint deadline = common::TimePoint::max();
    // Maximum time that one reply may wait for its reader.
    double write_timeout_seconds = std::numeric_limits<double>::infinity();
    bool takes_messages = false;  // after the first one
  };

  static std::shared_ptr<Call> Create(Parts parts) {
    return std::shared_ptr<Call>(new Call(std::move(parts)));
  }

  // The first message has arrived. Returns false if the call has ended: nobody handles the message.
  bool OnFirstMessage();
  // The first message will not arrive. `cancelled`: the caller has gone.
  void OnNoMessage(bool cancelled);

  // While the first message is handled: why the call is to end, if that is known.
  std::optional<absl::Status> ended_meanwhile() const;
  // Ends the handling with an error. Everything the call holds is released first.
  void Refuse(const absl::Status& reason);
  // Ends the handling by streaming replies.
  void Run(Stream stream);

  // Reads the next message for the source. If none arrives within `timeout_seconds`, aborts the
  // call with DEADLINE_EXCEEDED. Returns false, and reads nothing, if the call has ended or takes
  // no further message, or if a message is being read already.
  bool ReadNext(double timeout_seconds);
  // A further message has arrived.
  void OnMessage(grpc::ByteBuffer bytes);
  // No further message will arrive.
  void OnEndOfMessages();
  // The write that Transport::Write began is over. `ok`: the caller took the reply.
  void OnWritten(bool ok);

  const std::string& client() const { return parts_.client; }
  // The server begins to drain: notifies the source, now or as soon as there is one.
  void Drain();
  // Ends the call early. The first reason counts.
  void Abort(const absl::Status& reason);
  // If the call was aborted and its last write is still in progress, breaks that off.
  void BreakOffWrite();
  // Ends the call if a time limit has passed.
  void CheckTime(common::TimePoint now);

 private:
  enum class State {
    kReceiving,  // the first message
    kHandling,   // the first message
    kIdle,       // no reply is ready
    kAsking,     // the source is being asked for a reply
    kWriting,
    kFinished
  };

  // A further message that is being read.
  struct Reading {
    common::TimePoint begin;
    double timeout_seconds = 0;
  };

  explicit Call(Parts parts) : parts_(std::move(parts)), begin_(parts_.clock->Now()) {}

  bool is_streaming() const DUET_REQUIRES(mutex_) {
    return state_ == State::kIdle || state_ == State::kAsking || state_ == State::kWriting;
  }
  // If the state is `state`, ends the call with `reason` and returns true.
  bool EndFrom(State state, const absl::Status& reason) DUET_EXCLUDES(mutex_);
  // The first reason counts.
  void SetEnd(const absl::Status& reason) DUET_REQUIRES(mutex_);
  // Gets permission to arrive slowly, if the first message needs it by now.
  absl::Status CheckArrival(common::TimePoint now) DUET_REQUIRES(mutex_);
  // Sets end_ if a stream has taken too long. Returns true if the write in progress is to be broken
  // off.
  bool EndLate(common::TimePoint now) DUET_REQUIRES(mutex_);
  // The reading ends. Returns whether the source gets its result.
  bool FinishReading() DUET_REQUIRES(mutex_);
  // If nothing is being written: writes the next reply, or ends the call.
  void Advance() DUET_EXCLUDES(mutex_);
  // Ends the call with `reason` although a write is in progress. Requires breaking_off_ to be set.
  void BreakOff(const absl::Status& reason) DUET_EXCLUDES(mutex_);
  // Requires kFinished.
  void Finish(const absl::Status& status) DUET_EXCLUDES(mutex_);

  Parts parts_;  // the scope is used only by the thread that last changed state_
  const common::TimePoint begin_;

  mutable common::Mutex mutex_;
  State state_ DUET_GUARDED_BY(mutex_) = State::kReceiving;
  std::optional<absl::Status> end_ DUET_GUARDED_BY(mutex_);  // how the call is to finish
  ShareLease slow_ DUET_GUARDED_BY(mutex_);  // permission to arrive slowly, if one was needed
  bool draining_ DUET_GUARDED_BY(mutex_) = false;

  // Constant from Run on, except held_bytes and takes_messages, which mutex_ guards.
  Stream stream_;
  bool again_ DUET_GUARDED_BY(mutex_) = false;  // progress was made while the source was asked
  std::optional<Reading> reading_ DUET_GUARDED_BY(mutex_);
  common::TimePoint write_began_ DUET_GUARDED_BY(mutex_);
  // While it is set, the call does not finish: the transport must stay.
  bool breaking_off_ DUET_GUARDED_BY(mutex_) = false;
};

// All active calls. Does not keep them alive.
//
// Threads: safe to call concurrently.
class ActiveCalls {
 public:
  // Counts a call until gRPC has finished it: its status has been sent.
  class Ticket {
   public:
    explicit Ticket(ActiveCalls& calls) : calls_(calls) { calls_.CountOpen(1); }
    ~Ticket() { calls_.CountOpen(-1); }
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;

   private:
    ActiveCalls& calls_;
  };

  void Add(const std::shared_ptr<Call>& call);
  // Notifies all calls, and every call that is added later, that the server drains.
  void Drain();
  // Ends all calls, and every call that is added later.
  void AbortAll(const absl::Status& reason);
  // Waits until gRPC has finished every call, at most `seconds`, then breaks off the writes of
  // those that were aborted.
  void FinishAborted(double seconds);
  void CheckTime(common::TimePoint now);

 private:
  std::vector<std::shared_ptr<Call>> All();
  void CountOpen(int calls);

  common::Mutex mutex_;
  common::CondVar changed_;
  int open_ DUET_GUARDED_BY(mutex_) = 0;  // tickets
  bool draining_ DUET_GUARDED_BY(mutex_) = false;
  std::optional<absl::Status> ended_ DUET_GUARDED_BY(mutex_);  // why calls added later end at once
  std::vector<std::weak_ptr<Call>> calls_ DUET_GUARDED_BY(mutex_);  // CheckTime removes ended ones
};

// A gRPC service whose methods receive calls when their headers arrive, and messages as bytes.
// Services generated by protoc receive a call after its message was read, whatever its size and
// however many others are being read. That is too late for admission.
class RawService : public grpc::Service {
 protected:
  using Reactor = grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>;

  // Serves `method`, a string literal "/package.Service/Method". `open` must not block. It returns
  // a reactor that deletes itself.
  void Serve(const char* method, std::function<Reactor*(grpc::CallbackServerContext*)> open);

 private:
  int methods_ = 0;
};

// Connects a call of any method to gRPC. Deletes itself when gRPC has finished with it.
//
// A bidirectional reactor, even for methods that take or return one message. For all other kinds,
// gRPC reads the request before it reports the call, so memory would depend on what callers send.
// On the wire, a stream of one message and a single message are the same.
class CallReactor final : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                          public Transport {
 public:
  // Handles the first message: refuses or runs the call.
  using Handler = std::function<void(const std::shared_ptr<Call>&, grpc::ByteBuffer)>;

  // `calls` outlives the reactor.
  CallReactor(grpc::CallbackServerContext& context, ActiveCalls& calls)
      : context_(context), open_(calls) {}

  // Reads the first message of an admitted call. A refused call needs only Finish.
  void Receive(std::shared_ptr<Call> call, Handler handle);

  void Read() override { StartRead(&request_); }
  void Write(const google::protobuf::Message& reply) override;
  void Finish(CallScope& scope, const absl::Status& status) override;
  void BreakOff(const absl::Status& reason) override;

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override { delete this; }

 private:
  grpc::CallbackServerContext& context_;
  const ActiveCalls::Ticket open_;
  Handler handle_;              // null once the first message has arrived
  std::shared_ptr<Call> call_;  // null: refused at the headers
  grpc::ByteBuffer request_;    // being read
  grpc::ByteBuffer reply_;      // being written
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CALL_H_
