#ifndef DUET_SERVER_SERVICE_CALL_REACTOR_H_
#define DUET_SERVER_SERVICE_CALL_REACTOR_H_

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/server_callback.h>

#include <functional>
#include <memory>

#include "absl/status/status.h"
#include "duet/v1/synthesis.pb.h"
#include "server/service/open_calls.h"
#include "server/service/reception.h"
#include "server/service/synthesis_call.h"

namespace duet::server::service {

// Joins a call of any method to gRPC. Deletes itself when gRPC is done with it.
//
// A bidirectional reactor, whatever the contract says of the method: gRPC reads the message of any
// other before it tells of the call, so that whoever sends the most decides how much is in memory.
// On the wire one message each way is the same.
class CallReactor final : public grpc::ServerBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                          public ReplyWriter {
 public:
  // What is done with the message: the reception is refused, answered or goes on.
  using Handler =
      std::function<void(CallReactor&, const std::shared_ptr<Reception>&, grpc::ByteBuffer)>;

  // `open_calls` outlives the reactor.
  CallReactor(grpc::CallbackServerContext& context, OpenCalls& open_calls)
      : context_(context), open_(open_calls) {}

  // Reads the message of an admitted call. A refused one needs Finish alone.
  void Receive(std::shared_ptr<Reception> reception, Handler handle);
  // Answers with one message.
  void Respond(CallScope& scope, grpc::ByteBuffer response);
  // Answers with a stream.
  void Run(std::shared_ptr<SynthesisCall> call);

  void Write(const v1::SynthesizeResponse& reply) override;
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
  Handler handle_;
  std::shared_ptr<Reception> reception_;  // null: refused at the headers
  std::shared_ptr<SynthesisCall> call_;
  grpc::ByteBuffer request_;  // being read
  grpc::ByteBuffer reply_;    // being written
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CALL_REACTOR_H_
