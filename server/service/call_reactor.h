#ifndef DUET_SERVER_SERVICE_CALL_REACTOR_H_
#define DUET_SERVER_SERVICE_CALL_REACTOR_H_

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <functional>
#include <memory>

#include "absl/status/status.h"
#include "server/service/active_calls.h"
#include "server/service/reception.h"
#include "server/service/streaming_call.h"

namespace duet::server::service {

// Connects a call of any method to gRPC. Deletes itself when gRPC has finished with it.
//
// A bidirectional reactor, even for methods that take or return one message. For all other kinds,
// gRPC reads the request before it reports the call, so memory would depend on what callers send.
// On the wire, a stream of one message and a single message are the same.
class CallReactor final : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                          public ReplyWriter,
                          public MessageReader {
 public:
  // Handles the first message: refuses or answers the reception, or lets it go on.
  using Handler =
      std::function<void(CallReactor&, const std::shared_ptr<Reception>&, grpc::ByteBuffer)>;

  // `open_calls` outlives the reactor.
  CallReactor(grpc::CallbackServerContext& context, OpenCalls& open_calls)
      : context_(context), open_(open_calls) {}

  // Reads the first message of an admitted call. A refused call needs only Finish.
  void Receive(std::shared_ptr<Reception> reception, Handler handle);
  // Replies with one message.
  void Respond(CallScope& scope, grpc::ByteBuffer response);
  // Replies with a stream. `further`: see Reception::GoOn.
  void Run(std::shared_ptr<StreamingCall> call, std::shared_ptr<MessageSink> further = nullptr);

  void Read() override { StartRead(&request_); }
  void Write(const google::protobuf::Message& reply) override;
  void Finish(CallScope& scope, const absl::Status& status) override;
  void BreakOff(const absl::Status& reason) override;

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override { delete this; }

  const grpc::CallbackServerContext& context() const { return context_; }

 private:
  grpc::CallbackServerContext& context_;
  const OpenCalls::Ticket open_;
  Handler handle_;                        // null once the first message has arrived
  std::shared_ptr<Reception> reception_;  // null: refused at the headers
  std::shared_ptr<StreamingCall> call_;
  grpc::ByteBuffer request_;  // being read
  grpc::ByteBuffer reply_;    // being written
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CALL_REACTOR_H_
